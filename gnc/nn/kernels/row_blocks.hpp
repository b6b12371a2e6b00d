// Convolution in blocks of adjacent pixels of one row, which skip the zeros beside the image. Included by the
// source files of the instruction sets, like blocks.hpp.
#pragma once

#include "gnc/nn/kernels/blocks.hpp"

namespace tumblesight::gnc {
namespace {

// Ops: as for Blocks.
template <class Ops>
struct RowBlocks {
  using Input = typename Ops::Kind::Input;
  using Weight = typename Ops::Kind::Weight;
  using Sum = typename Ops::Kind::Sum;
  static constexpr int kGroup = Ops::Kind::kGroup;
  static constexpr int kWidth = Ops::kWidth;

  // Adds the products of the inputs [begin, end) of pixels [kFrom, kTo) of the block. Returns the weights
  // that follow.
  template <int kFrom, int kTo, int kPixels, int kPacks>
  TUMBLESIGHT_INLINE const Weight* add(const ProductShape& shape, const Input* const (&in)[kPixels],
                                       int begin, int end, const Weight* weights,
                                       typename Ops::Sums (&sum)[kPixels][kPacks]) {
    for (int i = begin; i < end; i += kGroup, weights += shape.channels * kGroup) {
      typename Ops::Weights weight[kPacks];
#pragma GCC unroll 16
      for (int c = 0; c < kPacks; ++c) weight[c] = Ops::weights(weights + c * kWidth * kGroup);
#pragma GCC unroll 16
      for (int p = kFrom; p < kTo; ++p) {
        const typename Ops::Values value = Ops::values(in[p] + i);
#pragma GCC unroll 16
        for (int c = 0; c < kPacks; ++c) Ops::add(sum[p][c], value, weight[c]);
      }
    }
    return weights;
  }

  // kPixels pixels and kPacks vectors of channels. Skips the zeros of the first pixel if kFirst, those of the
  // last one if kLast. `in`, `start`, `weights` and `out` point to the first pixel and channel of the block;
  // `start_step`: from the start of one pixel to that of the next, 0 if it is the same for all.
  template <int kPixels, int kPacks, bool kFirst, bool kLast>
  TUMBLESIGHT_INLINE void block(const ProductShape& shape, const Input* in, const Sum* start, int start_step,
                                const Weight* weights, Sum* out) {
    typename Ops::Sums sum[kPixels][kPacks];
    const Input* pixel[kPixels];
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
      pixel[p] = in + p * shape.column_step;
#pragma GCC unroll 16
      for (int c = 0; c < kPacks; ++c) sum[p][c] = Ops::load(start + p * start_step + c * kWidth);
    }
    for (int strip = 0; strip < shape.strips; ++strip) {
      const int begin = strip * shape.strip_step, end = begin + shape.strip_length;
      const int left = kFirst ? begin + shape.column_step : begin;
      const int right = kLast ? end - shape.column_step : end;
      if constexpr (kFirst) weights = add<1, kPixels>(shape, pixel, begin, left, weights, sum);
      weights = add<0, kPixels>(shape, pixel, left, right, weights, sum);
      if constexpr (kLast) weights = add<0, kPixels - 1>(shape, pixel, right, end, weights, sum);
    }
#pragma GCC unroll 16
    for (int p = 0; p < kPixels; ++p) {
#pragma GCC unroll 16
      for (int c = 0; c < kPacks; ++c) Ops::store(sum[p][c], out + p * shape.channels + c * kWidth);
    }
  }

  // Whether product() can compute `shape`.
  template <int kPixels, int kPacks>
  TUMBLESIGHT_INLINE bool fit(const ProductShape& shape) {
    return shape.columns % kPixels == 0 && shape.channels % (kPacks * kWidth) == 0 &&
           shape.strip_length >= 2 * shape.column_step;
  }

  template <int kPixels, int kPacks>
  TUMBLESIGHT_INLINE void product(const ProductShape& shape, const Input* in, const Sum* start,
                                  int start_step, const Weight* weights, Sum* out) {
    const int last = shape.columns - kPixels;
    for (int c = 0; c < shape.channels; c += kPacks * kWidth) {
      const Weight* const from = weights + c * kGroup;
      for (int y = 0; y < shape.rows; ++y) {
        for (int x = 0; x <= last; x += kPixels) {
          const Input* const pixel = in + y * shape.row_step + x * shape.column_step;
          const int first = y * shape.columns + x;
          const Sum* const begin = start + first * start_step + c;
          Sum* const to = out + first * shape.channels + c;
          const bool skips_left = x == 0 && shape.zeros_left > 0;
          const bool skips_right = x == last && shape.zeros_right > 0;
          if (skips_left && skips_right) {
            block<kPixels, kPacks, true, true>(shape, pixel, begin, start_step, from, to);
          } else if (skips_left) {
            block<kPixels, kPacks, true, false>(shape, pixel, begin, start_step, from, to);
          } else if (skips_right) {
            block<kPixels, kPacks, false, true>(shape, pixel, begin, start_step, from, to);
          } else {
            block<kPixels, kPacks, false, false>(shape, pixel, begin, start_step, from, to);
          }
        }
      }
    }
  }
};

}  // namespace
}  // namespace tumblesight::gnc
