// Convolution for processors without vectors. Loading and widening inputs costs them most, so it is done once
// for all channels: for a few pixels and one chunk of their inputs at a time. Included by the source files of
// the instruction sets, like blocks.hpp.
#pragma once

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

// Ops defines kPixels, kChunkGroups (groups per chunk), a type Group (the inputs of one group for kPixels
// pixels, in the layout that add() needs), and
//   void prepare(const std::uint8_t* const (&in)[kPixels], int offset, Group&)
//   void add(const Group* chunk, int groups, const std::int32_t* start, int start_step,
//            const std::int8_t* weights, std::int32_t* out, int channels)
// add() adds the products of the chunk to `start` and writes the sums to `out`, for all channels. The sum of
// pixel p and channel c is at start[p * start_step + c] and out[p * channels + c]. add() should not be
// inlined ([[gnu::noinline]]): otherwise the compiler splits the chunk into separate variables.
template <class Ops>
struct ChunkedConvolution {
  static constexpr int kPixels = Ops::kPixels;
  static constexpr int kGroup = Int8Product::kGroup;

  // Position of the next group: its strip and the offset within the strip.
  struct Position {
    int strip = 0, offset = 0;
  };

  TUMBLESIGHT_INLINE void prepare(const ProductShape& shape, const std::uint8_t* const (&in)[kPixels],
                                  int groups, Position& position, typename Ops::Group* chunk) {
    for (int g = 0; g < groups; ++g) {
      Ops::prepare(in, position.strip * shape.strip_step + position.offset, chunk[g]);
      position.offset += kGroup;
      if (position.offset == shape.strip_length) position = {position.strip + 1, 0};
    }
  }

  TUMBLESIGHT_INLINE void pixels(const ProductShape& shape, const std::uint8_t* const (&in)[kPixels],
                                 const std::int32_t* start, const std::int8_t* weights, std::int32_t* out) {
    typename Ops::Group chunk[Ops::kChunkGroups];
    Position position;
    int start_step = 0;  // the same for every pixel
    for (int remaining = shape.strips * shape.strip_length / kGroup; remaining > 0;
         remaining -= Ops::kChunkGroups) {
      const int groups = min(remaining, Ops::kChunkGroups);
      prepare(shape, in, groups, position, chunk);
      Ops::add(chunk, groups, start, start_step, weights, out, shape.channels);
      weights += groups * kGroup * shape.channels;
      start = out;
      start_step = shape.channels;
    }
  }

  // The last pixels are moved back to end at the last one; the pixels computed a second time get the same
  // values.
  TUMBLESIGHT_INLINE void product(const ProductShape& shape, const std::uint8_t* in,
                                  const std::int32_t* start, const std::int8_t* weights, std::int32_t* out) {
    const int count = shape.rows * shape.columns;
    for (int next = 0; next < count; next += kPixels) {
      const int first = min(next, count - kPixels);
      const std::uint8_t* pixel_in[kPixels];
      for (int p = 0; p < kPixels; ++p) {
        const int y = (first + p) / shape.columns;
        pixel_in[p] = in + y * shape.row_step + (first + p - y * shape.columns) * shape.column_step;
      }
      pixels(shape, pixel_in, start, weights, out + first * shape.channels);
    }
  }
};

}  // namespace
}  // namespace tumblesight::gnc
