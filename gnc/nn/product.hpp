// Sliding product: the one operation under convolutions and dense layers, and the kinds of numbers it is made
// of.
#pragma once

#include <cstdint>

namespace tumblesight::gnc {

// Kinds. Weights lie in groups: kGroup inputs of one output channel side by side.
struct Float32Product {
  using Input = float;
  using Weight = float;
  using Sum = float;
  static constexpr int kGroup = 1;
};
struct Int8Product {
  using Input = std::uint8_t;
  using Weight = std::int8_t;
  using Sum = std::int32_t;
  static constexpr int kGroup = 4;
};
struct Int16Product {
  using Input = std::int16_t;
  using Weight = std::int8_t;
  using Sum = std::int32_t;
  static constexpr int kGroup = 2;
};

// For every output pixel (y, x) of rows x columns and every output channel c:
//   out[(y * columns + x) * channels + c] = start[c]
//     + sum over strips t, then i = 0 .. strip_length - 1, of
//       in[y * row_step + x * column_step + t * strip_step + i]
//       * weights[((t * strip_length + i) / kGroup * channels + c) * kGroup + i % kGroup]
// Floats are added one by one in that order, products rounded before they are added (-ffp-contract=off), and
// vectors run across output channels, so the bits of an output are the same whatever the vector width.
// Integers are exact in any order, since no sum can leave 32 bits: model_image.hpp sees to it.
//
// A 3x3 convolution over a zero-padded HWC image is three strips (ky) of 3 * channels_in numbers (kx,
// channel); a dense layer is one pixel and one strip. The work done depends on the shape only, never on the
// numbers.
struct ProductShape {
  int rows;
  int columns;
  int row_step;     // numbers from one row of `in` to the next
  int column_step;  // numbers from one pixel of `in` to the next
  int strips;
  int strip_length;  // a multiple of kGroup
  int strip_step;
  int channels;  // output channels; of integers a multiple of kIntegerChannels
};
inline constexpr int kIntegerChannels = 16;

// Inputs of integers begin at a multiple of kGroup numbers in memory, rows, pixels and strips likewise.
//
// `start` may be `out` itself when there is one pixel: the product is then added to what lies there. `in`,
// `weights` and `out` must not overlap.
template <class Kind>
using Product = void(const ProductShape& shape, const typename Kind::Input* in,
                     const typename Kind::Sum* start, const typename Kind::Weight* weights,
                     typename Kind::Sum* out);

}  // namespace tumblesight::gnc
