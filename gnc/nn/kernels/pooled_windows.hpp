// Pooling in fixed point, 16 channels at a time, and the convolution of an image with four channels that
// pools its sums in registers. Included by the source files of the instruction sets, like blocks.hpp.
#pragma once

#include "gnc/nn/kernels/blocks.hpp"
#include "gnc/nn/kernels/kernels.hpp"

namespace tumblesight::gnc {
namespace {

// Pool defines a type Sums (the sums of 16 channels), a type Rounding and
//   Sums load(const std::int32_t*), max(Sums, Sums), add(Sums, Sums)
//   Rounding rounding(const std::uint8_t* shift)
//   Sums requantize(Sums, const Rounding&)       as in numerics.hpp
//   Sums limit(Sums, std::int32_t largest)       to [0, largest]
//   void store(Sums, std::uint8_t*)              saturated to [0, 255]
//   void store(Sums, std::int16_t*)              of numbers that fit
template <class Pool>
struct PooledWindows {
  using Sums = typename Pool::Sums;
  static constexpr int kWidth = kIntegerChannels;

  // max_pool() and average_pool() of kernels.hpp.
  TUMBLESIGHT_INLINE void max_pool(const std::int32_t* sums, int columns, int channels,
                                   const std::uint8_t* shift, std::uint8_t* out) {
    for (int c = 0; c < channels; c += kWidth) {
      const auto rounding = Pool::rounding(shift + c);
      const std::int32_t* above = sums + c;
      for (int x = 0; x + 1 < columns; x += 2, above += 2 * channels) {
        const std::int32_t* const below = above + columns * channels;
        const Sums largest = Pool::max(Pool::max(Pool::load(above), Pool::load(above + channels)),
                                       Pool::max(Pool::load(below), Pool::load(below + channels)));
        Pool::store(Pool::requantize(largest, rounding), out + x / 2 * channels + c);
      }
    }
  }
  TUMBLESIGHT_INLINE void average_pool(const std::int32_t* sums, int columns, int channels,
                                       const std::uint8_t* shift, std::int16_t* out) {
    for (int c = 0; c < channels; c += kWidth) {
      const auto rounding = Pool::rounding(shift + c);
      const auto activate = [&rounding](const std::int32_t* from) __attribute__((always_inline)) {
        return Pool::limit(Pool::requantize(Pool::load(from), rounding), kMaxAveragedActivation);
      };
      const std::int32_t* above = sums + c;
      for (int x = 0; x + 1 < columns; x += 2, above += 2 * channels) {
        const std::int32_t* const below = above + columns * channels;
        const Sums total = Pool::add(Pool::add(activate(above), activate(above + channels)),
                                     Pool::add(activate(below), activate(below + channels)));
        Pool::store(total, out + x / 2 * channels + c);
      }
    }
  }

  // Convolution of an image of four channels, whose sums stay in registers.
  static constexpr int kGroup = Int8Product::kGroup;
  TUMBLESIGHT_INLINE bool fits(const ImageShape& shape) { return shape.channels_in == kGroup; }

  // Sums of a window, without the start, of kPacks packs of 16 channels. `weight_step`: from the weights of
  // one group to those of the next.
  template <class Ops, int kPacks>
  TUMBLESIGHT_INLINE void sum_window(const typename Ops::Input* in, int row,
                                     const typename Ops::Weight* weights, int weight_step,
                                     Sums (&sum)[2][2][kPacks]) {
    for (int strip = 0; strip < 3; ++strip, in += row) {
#pragma GCC unroll 3
      for (int column = 0; column < 3; ++column, weights += weight_step) {
        typename Ops::Weights weight[kPacks];
#pragma GCC unroll 2
        for (int c = 0; c < kPacks; ++c) weight[c] = Ops::weights(weights + c * kWidth * kGroup);
#pragma GCC unroll 2
        for (int y = 0; y < 2; ++y) {
#pragma GCC unroll 2
          for (int x = 0; x < 2; ++x) {
            const auto value = Ops::values(in + y * row + (x + column) * kGroup);
#pragma GCC unroll 2
            for (int c = 0; c < kPacks; ++c) Ops::add(sum[y][x][c], value, weight[c]);
          }
        }
      }
    }
  }

  // A row of windows in kPacks packs of 16 channels. The start is added to the largest sum of a window. Ops:
  // as for Blocks, with 16 channels per vector of weights and sums.
  template <class Ops, int kPacks>
  TUMBLESIGHT_INLINE void convolve_row(const ImageShape& shape, const typename Ops::Input* in,
                                       const std::int32_t* start, const typename Ops::Weight* weights,
                                       int weight_step, const std::uint8_t* shift, std::uint8_t* out) {
    typename Pool::Rounding rounding[kPacks];
#pragma GCC unroll 2
    for (int c = 0; c < kPacks; ++c) rounding[c] = Pool::rounding(shift + c * kWidth);
    for (int x = 0; x < shape.side / 2; ++x) {
      Sums sum[2][2][kPacks] = {};
      sum_window<Ops, kPacks>(in + x * 2 * kGroup, shape.row(), weights, weight_step, sum);
#pragma GCC unroll 2
      for (int c = 0; c < kPacks; ++c) {
        const Sums largest =
            Pool::max(Pool::max(sum[0][0][c], sum[0][1][c]), Pool::max(sum[1][0][c], sum[1][1][c]));
        Pool::store(Pool::requantize(Pool::add(largest, Pool::load(start + c * kWidth)), rounding[c]),
                    out + x * shape.channels_out + c * kWidth);
      }
    }
  }

  // The image, kPacks packs at a time and the remaining ones alone.
  template <class Ops, int kPacks>
  TUMBLESIGHT_INLINE void convolve(const ImageShape& shape, const std::uint8_t* in, const std::int32_t* start,
                                   const std::int8_t* weights, const std::uint8_t* shift, std::uint8_t* out,
                                   int out_row) {
    const int weight_step = shape.channels_out * kGroup;
    for (int y = 0; y < shape.side / 2; ++y, in += 2 * shape.row(), out += out_row) {
      int c = 0;
      for (; c + kPacks * kWidth <= shape.channels_out; c += kPacks * kWidth) {
        convolve_row<Ops, kPacks>(shape, in, start + c, weights + c * kGroup, weight_step, shift + c,
                                  out + c);
      }
      for (; c < shape.channels_out; c += kWidth) {
        convolve_row<Ops, 1>(shape, in, start + c, weights + c * kGroup, weight_step, shift + c, out + c);
      }
    }
  }
};

}  // namespace
}  // namespace tumblesight::gnc
