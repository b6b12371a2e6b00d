// Convolution for processors without vectors. What costs them most is to fetch and widen inputs, so that is
// done once for all channels: a few pixels side by side, a stretch of their inputs at a time. Included by
// source files as blocks.hpp is.
#pragma once

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

// A Unit names kPixels, kStretch (groups), a type Group (a group's inputs of these pixels, as it likes them),
// and
//   void prepare(const std::uint8_t* const (&in)[kPixels], int offset, Group&)
//   void add(const Group* stretch, int groups, const std::int32_t* start, int start_step, const std::int8_t*
//   weights,
//            std::int32_t* out, int channels)
// which adds the stretch's products of every channel to `start` and writes the sums to `out`. Of pixel p and
// channel c they lie at start[p * start_step + c] and out[p * channels + c]. add() had best be a function of
// its own ([[gnu::noinline]]), lest the compiler take the stretch apart.
template <class Unit>
struct Stretches {
  static constexpr int kPixels = Unit::kPixels;
  static constexpr int kGroup = Int8Product::kGroup;

  // Which group comes next: they run through one strip after the other.
  struct Place {
    int strip = 0, offset = 0;
  };

  TUMBLESIGHT_INLINE void prepare(const ProductShape& shape, const std::uint8_t* const (&in)[kPixels],
                                  int groups, Place& place, typename Unit::Group* stretch) {
    for (int g = 0; g < groups; ++g) {
      Unit::prepare(in, place.strip * shape.strip_step + place.offset, stretch[g]);
      place.offset += kGroup;
      if (place.offset == shape.strip_length) place = {place.strip + 1, 0};
    }
  }

  TUMBLESIGHT_INLINE void pixels(const ProductShape& shape, const std::uint8_t* const (&in)[kPixels],
                                 const std::int32_t* start, const std::int8_t* weights, std::int32_t* out) {
    typename Unit::Group stretch[Unit::kStretch];
    Place place;
    int start_step = 0;  // the same for every pixel
    for (int rest = shape.strips * shape.strip_length / kGroup; rest > 0; rest -= Unit::kStretch) {
      const int groups = min(rest, Unit::kStretch);
      prepare(shape, in, groups, place, stretch);
      Unit::add(stretch, groups, start, start_step, weights, out, shape.channels);
      weights += groups * kGroup * shape.channels;
      start = out;
      start_step = shape.channels;
    }
  }

  // The last pixels are moved back to end at the last one; what is done again comes out the same.
  TUMBLESIGHT_INLINE void product(const ProductShape& shape, const std::uint8_t* in,
                                  const std::int32_t* start, const std::int8_t* weights, std::int32_t* out) {
    const int count = shape.rows * shape.columns;
    for (int next = 0; next < count; next += kPixels) {
      const int first = min(next, count - kPixels);
      const std::uint8_t* of_pixel[kPixels];
      for (int p = 0; p < kPixels; ++p) {
        const int y = (first + p) / shape.columns;
        of_pixel[p] = in + y * shape.row_step + (first + p - y * shape.columns) * shape.column_step;
      }
      pixels(shape, of_pixel, start, weights, out + first * shape.channels);
    }
  }
};

}  // namespace
}  // namespace tumblesight::gnc
