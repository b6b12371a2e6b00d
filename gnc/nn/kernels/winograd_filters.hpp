// Winograd's minimal filters F(4, 3) and F(2, 3) in integers: kTile sums of three products each, out of
// kPatch = kTile + 2 products. Used for rows and columns they make a tile of kTile x kTile sums of a 3x3
// convolution from kPatch x kPatch inputs d and 3x3 weights g:
//   A' [(G g G') * (B' d B)] A        * multiplies element by element
// The fractions of A are left out, so that all numbers are integers and the sum of row i and column j comes
// out times a factor, which unscaled() takes off. Each struct has
//   inputs<Arithmetic>()    B' d
//   weights<Arithmetic>()   G g
//   sums<Arithmetic>()      A' m, with the factors
// of Values with Arithmetic::add(a, b), sub(a, b) and shift<bits>(a) to the left. Included by the source
// files of the instruction sets, like blocks.hpp.
#pragma once

#include <cstdint>

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

//        4  0 -5  0  1  0          3  0  0           2  0  0  0     Column j of A is multiplied by the
//        0 -4 -4  1  1  0          1  1  1          -4 -2 -1 -1     factor 24, 12, 6, 6 that makes it an
//   B' = 0  4 -4 -1  1  0      G = 1 -1  1      A = -4  2 -1  1     integer, so the sums of row i and
//        0 -2 -1  2  1  0          1  2  4           1  1  1  2     column j of a tile come out times
//        0  2 -1 -2  1  0          1 -2  4           1 -1  1 -2     9 2^(e(i) + e(j)), e = 3, 2, 1, 1.
//        0  4  0 -5  0  1          0  0  3           0  0  0  2
// Inputs of 8 bits become at most 17340 in magnitude, weights at most 6272: both fit into 16 bits. The sums
// of their products may exceed 32 bits. They count modulo 2^32, where 9 has an inverse; a sum is exact if its
// magnitude is below 2^25, which kMaxChannelsIn ensures.
struct MinimalFilter4 {
  static constexpr int kTile = 4, kPatch = 6;
  static constexpr int kMaxChannelsIn = 96;  // 9 * 96 * 255 * 127 < 2^25
  static constexpr int kShifts[kTile] = {3, 2, 1, 1};
  static constexpr std::uint32_t kInverseOf9 = 954437177;  // modulo 2^32

  template <class Arithmetic, class Value>
  TUMBLESIGHT_INLINE void inputs(const Value (&d)[kPatch], Value (&out)[kPatch]) {
    using A = Arithmetic;
    const Value d42 = A::sub(d[4], d[2]), d31 = A::sub(d[3], d[1]);
    const Value twice = A::add(d31, d31);
    out[0] = A::add(A::template shift<2>(A::sub(d[0], d[2])), d42);
    out[1] = A::sub(A::add(d[3], d[4]), A::template shift<2>(A::add(d[1], d[2])));
    out[2] = A::add(A::sub(d[4], d[3]), A::template shift<2>(A::sub(d[1], d[2])));
    out[3] = A::add(d42, twice);
    out[4] = A::sub(d42, twice);
    out[5] = A::sub(A::sub(d[5], d[3]), A::template shift<2>(d31));
  }
  template <class Arithmetic, class Value>
  TUMBLESIGHT_INLINE void weights(const Value (&g)[3], Value (&out)[kPatch]) {
    using A = Arithmetic;
    const Value ends = A::add(g[0], g[2]), far = A::add(g[0], A::template shift<2>(g[2]));
    const Value twice = A::add(g[1], g[1]);
    out[0] = A::add(g[0], A::add(g[0], g[0]));
    out[1] = A::add(ends, g[1]);
    out[2] = A::sub(ends, g[1]);
    out[3] = A::add(far, twice);
    out[4] = A::sub(far, twice);
    out[5] = A::add(g[2], A::add(g[2], g[2]));
  }
  template <class Arithmetic, class Value>
  TUMBLESIGHT_INLINE void sums(const Value (&m)[kPatch], Value (&out)[kTile]) {
    using A = Arithmetic;
    const Value p = A::add(m[1], m[2]), q = A::sub(m[1], m[2]);
    const Value r = A::add(m[3], m[4]), s = A::sub(m[3], m[4]);
    out[0] = A::add(A::template shift<1>(A::sub(m[0], A::add(p, p))), r);
    out[1] = A::sub(s, A::add(q, q));
    out[2] = A::sub(r, p);
    out[3] = A::sub(A::template shift<1>(A::add(s, m[5])), q);
  }
  TUMBLESIGHT_INLINE std::int32_t unscaled(std::uint32_t sum, int row, int column) {
    return static_cast<std::int32_t>(sum * kInverseOf9) >> (kShifts[row] + kShifts[column]);
  }
};

//        1  0 -1  0          1  0  0          2  0     Both columns of A are multiplied by 2, so the
//   B' = 0  1  1  0      G = 1  1  1      A = 1  1     sums of a tile come out times 4.
//        0 -1  1  0          1 -1  1          1 -1
//        0  1  0 -1          0  0  1          0 -2
struct MinimalFilter2 {
  static constexpr int kTile = 2, kPatch = 4;
  static constexpr int kMaxChannelsIn = 1024;  // 9 * 1024 * 255 * 127 < 2^29

  template <class Arithmetic, class Value>
  TUMBLESIGHT_INLINE void inputs(const Value (&d)[kPatch], Value (&out)[kPatch]) {
    using A = Arithmetic;
    out[0] = A::sub(d[0], d[2]);
    out[1] = A::add(d[1], d[2]);
    out[2] = A::sub(d[2], d[1]);
    out[3] = A::sub(d[1], d[3]);
  }
  template <class Arithmetic, class Value>
  TUMBLESIGHT_INLINE void weights(const Value (&g)[3], Value (&out)[kPatch]) {
    using A = Arithmetic;
    const Value ends = A::add(g[0], g[2]);
    out[0] = g[0];
    out[1] = A::add(ends, g[1]);
    out[2] = A::sub(ends, g[1]);
    out[3] = g[2];
  }
  template <class Arithmetic, class Value>
  TUMBLESIGHT_INLINE void sums(const Value (&m)[kPatch], Value (&out)[kTile]) {
    using A = Arithmetic;
    out[0] = A::add(A::template shift<1>(m[0]), A::add(m[1], m[2]));
    out[1] = A::sub(A::sub(m[1], m[2]), A::template shift<1>(m[3]));
  }
  TUMBLESIGHT_INLINE std::int32_t unscaled(std::uint32_t sum, int, int) {
    return static_cast<std::int32_t>(sum) >> 2;
  }
};

}  // namespace
}  // namespace tumblesight::gnc
