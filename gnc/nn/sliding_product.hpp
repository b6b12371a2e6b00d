// Sliding product: the one kernel under convolutions and dense layers.
#pragma once

namespace tumblesight::gnc {

// For every output pixel (y, x) of rows x columns and every output channel c:
//   out[(y * columns + x) * channels + c] = start[c]
//     + sum over strips t, then i = 0 .. strip_length - 1, of
//       in[y * row_step + x * column_step + t * strip_step + i] * weights[(t * strip_length + i) * channels +
//       c]
// added one by one in that order, so the bits of an output are the same whatever the vector width: vectors
// run across output channels, and products are rounded before they are added (-ffp-contract=off).
//
// A 3x3 convolution over a zero-padded HWC image is three strips (ky) of 3 * channels_in numbers (kx,
// channel); a dense layer is one pixel and one strip. The work done depends on the shape only, never on the
// numbers.
struct SlidingProductShape {
  int rows;
  int columns;
  int row_step;     // floats from one row of `in` to the next
  int column_step;  // floats from one pixel of `in` to the next
  int strips;
  int strip_length;
  int strip_step;
  int channels;  // output channels
};

// The kernel is compiled once in plain scalar code and once for every vector width the processor family
// knows.
enum class VectorUnit : unsigned char {
  kScalar,  // every processor
  k128Bit,  // SSE2 on x86-64, NEON on AArch64
  kAvx2,
  kAvx512,
};
bool is_available(VectorUnit unit);
VectorUnit widest_vector_unit();

// `start` may be `out` itself when there is one pixel: the product is then added to what lies there.
// `in`, `weights` and `out` must not overlap.
void sliding_product(const SlidingProductShape& shape, const float* in, const float* start,
                     const float* weights, float* out);
// The same on a given unit, which must be available; all give the same bits.
void sliding_product_on(VectorUnit unit, const SlidingProductShape& shape, const float* in,
                        const float* start, const float* weights, float* out);

}  // namespace tumblesight::gnc
