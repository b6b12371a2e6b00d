// ConvBlock: 3x3 convolution, pooling 2x2 and ReLU over a square HWC image, in one pass over pairs of rows.
//
// Layers are functions of their own ([[gnu::noinline]]), here and in dense.hpp and lstm.hpp, so that what
// each takes can be told apart (tests/audit).
#pragma once

#include <array>
#include <cstddef>

#include "gnc/nn/kernels.hpp"
#include "gnc/nn/numerics.hpp"

namespace tumblesight::gnc {

// A square HWC image inside a border of one pixel of zeros.
template <class Number, int kImageSide, int kImageChannels>
struct PaddedImage {
  static constexpr int kSide = kImageSide;
  static constexpr int kChannels = kImageChannels;
  static constexpr int kRow = (kSide + 2) * kChannels;  // numbers to a row
  std::array<Number, (kSide + 2) * kRow> number;

  Number* row(int y) { return number.data() + (y + 1) * kRow + kChannels; }  // inside the border
};

// Zero padding 1, stride 1. Pooling leaves out a last row and column that fill no whole window; they are not
// computed. Summation per output: bias, then ky, kx, input channel ascending; padding takes part as zeros.
template <class N, int kSide, int kChannelsIn, int kChannelsOut>
struct ConvBlock {
  static_assert(kSide > 1 && kChannelsOut % kIntegerChannels == 0);
  static constexpr int kSideOut = kSide / 2;
  static constexpr int kColumns = 2 * kSideOut;
  static constexpr int kWeights = 3 * 3 * kChannelsIn * kChannelsOut;
  static constexpr std::size_t kParameters = kWeights + kChannelsOut;
  static constexpr long kMacs = 1L * kColumns * kColumns * kWeights;  // padding included
  // What kernels do of them that compute so many pixels together.
  static constexpr long macs_done(int pixels) {
    const int rows_spared = kColumns % pixels != 0 ? 0 : kColumns == kSide ? 2 : 1;
    return kMacs - 1L * rows_spared * kColumns * kWeights / 3;
  }
  using Weights = LayerWeights<N, kWeights, kChannelsOut>;
  using Input = PaddedImage<ConvInput<N>, kSide, kChannelsIn>;
  using Sums = std::array<Sum<N>, 2 * kColumns * kChannelsOut>;  // scratch: two rows

  // The largest of each window, activated.
  using MaxPooled = PaddedImage<ConvInput<N>, kSideOut, kChannelsOut>;
  [[gnu::noinline]] static void forward(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                        Sums& sums, MaxPooled& out) {
    out.number.fill({});
    for (int y = 0; y < kSideOut; ++y) {
      two_rows(kernels, weights, in, y, sums);
      kernels.max_pool(sums.data(), kColumns, kChannelsOut, weights.shift.data(), out.row(y));
    }
  }

  // The windows' four numbers, activated and then averaged; in fixed point they are added.
  using AveragePooled = std::array<DenseInput<N>, kSideOut * kSideOut * kChannelsOut>;
  [[gnu::noinline]] static void forward(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                        Sums& sums, AveragePooled& out) {
    for (int y = 0; y < kSideOut; ++y) {
      two_rows(kernels, weights, in, y, sums);
      kernels.average_pool(sums.data(), kColumns, kChannelsOut, weights.shift.data(),
                           out.data() + y * kSideOut * kChannelsOut);
    }
  }

 private:
  // Rows 2 y and 2 y + 1. Where it costs nothing to compute them one by one, the first and the last row are
  // spared the padding above and below, which adds nothing.
  static void two_rows(const Kernels<N>& kernels, const Weights& weights, const Input& in, int y,
                       Sums& sums) {
    constexpr int kAll = 3;
    const bool spares = kColumns % kernels.pixels == 0;
    const int above = spares && y == 0 ? 1 : 0;
    const int below = spares && 2 * y + 2 == kSide ? 1 : 0;
    if (above + below == 0) {
      rows(kernels, weights, in, 2 * y, 2, 0, kAll, sums.data());
      return;
    }
    rows(kernels, weights, in, 2 * y, 1, above, kAll - above, sums.data());
    rows(kernels, weights, in, 2 * y + 1, 1, 0, kAll - below, sums.data() + kColumns * kChannelsOut);
  }

  // `count` rows of sums from `first` on, over the strips (ky) from first_strip on.
  static void rows(const Kernels<N>& kernels, const Weights& weights, const Input& in, int first, int count,
                   int first_strip, int strips, Sum<N>* sums) {
    const ProductShape shape{count,  kColumns,        Input::kRow, kChannelsIn,
                             strips, 3 * kChannelsIn, Input::kRow, kChannelsOut};
    kernels.convolve(shape, in.number.data() + (first + first_strip) * Input::kRow, weights.bias.data(),
                     weights.weight.data() + first_strip * 3 * kChannelsIn * kChannelsOut, sums);
  }
};

}  // namespace tumblesight::gnc
