// Sliding product: the operation that convolutions and dense layers consist of, and the number types it
// exists for.
#pragma once

#include <cstdint>

namespace tumblesight::gnc {

// Kinds of products. Weights are stored in groups: those of kGroup inputs of one output channel are adjacent.
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
// Floats are added one at a time in that order, and each product is rounded before it is added
// (-ffp-contract=off). Vectors run across output channels, so the bits of an output do not depend on the
// vector width. Integers are exact in any order: the check of the model image ensures that no sum exceeds 32
// bits.
//
// A 3x3 convolution over a zero-padded HWC image is three strips (ky) of 3 * channels_in values (kx,
// channel). A dense layer is one pixel and one strip. The executed instructions depend on the shape only, not
// on the values.
struct ProductShape {
  int rows;
  int columns;
  int row_step;     // values from one row of `in` to the next
  int column_step;  // values from one pixel of `in` to the next
  int strips;
  int strip_length;  // a multiple of kGroup
  int strip_step;    // values from one strip of `in` to the next
  int channels;      // output channels; for integers a multiple of kIntegerChannels
  // Inputs known to be zero, which need not be multiplied: at the start of each strip of a row's first pixel,
  // and at the end of each strip of its last pixel. column_step values or none.
  int zeros_left = 0;
  int zeros_right = 0;
};
inline constexpr int kIntegerChannels = 16;

// Computes the product above.
//
// in       for integers the address of every row, pixel and strip is a multiple of kGroup values
// start    `channels` sums. It may be `out` if there is one pixel: the product is then added to `out`
// weights  strips * strip_length * channels values, in groups
// out      rows * columns * channels sums
// `in`, `weights` and `out` must not overlap.
template <class Kind>
using Product = void(const ProductShape& shape, const typename Kind::Input* in,
                     const typename Kind::Sum* start, const typename Kind::Weight* weights,
                     typename Kind::Sum* out);

}  // namespace tumblesight::gnc
