// ConvBlock: 3x3 convolution, 2x2 pooling and ReLU over a square HWC image, by one kernel for the whole image
// or in one pass over pairs of rows.
//
// The functions of the layers, here and in dense.hpp and lstm.hpp, are [[gnu::noinline]], so that the audit
// can count the instructions of each layer (tests/audit).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/nn/kernels/kernels.hpp"
#include "gnc/nn/kernels/numerics.hpp"

namespace tumblesight::gnc {

// A square image in HWC order (row, column, channel) inside a border of one pixel of zeros.
template <class Number, int kImageSide, int kImageChannels>
struct PaddedImage {
  static constexpr int kSide = kImageSide;
  static constexpr int kChannels = kImageChannels;
  static constexpr int kRow = (kSide + 2) * kChannels;  // values per row
  std::array<Number, (kSide + 2) * kRow> values;

  Number* row(int y) { return values.data() + (y + 1) * kRow + kChannels; }  // first value inside the border
};

// Zero padding 1, stride 1. An odd last row and column, which fill no whole pooling window, are not computed.
// Order of summation of an output: bias, then ky, kx and input channel ascending; the padding is added as
// zeros.
//
// N: Float32 or FixedPoint. Input kSide x kSide x kChannelsIn, output kSideOut x kSideOut x kChannelsOut. In
// fixed point inputs are uint8, weights int8, sums int32 and each output channel has a shift of 1..30
// (docs/numerics.md).
template <class N, int kSide, int kChannelsIn, int kChannelsOut>
struct ConvBlock {
  static_assert(kSide > 1 && kChannelsOut % kIntegerChannels == 0);
  using Product = typename N::ConvProduct;
  static constexpr std::int64_t kLargestSum = kMaxConvSum;  // in fixed point: magnitude, rounding included
  static constexpr int kSideOut = kSide / 2;
  static constexpr int kColumns = 2 * kSideOut;
  static constexpr int kWeights = 3 * 3 * kChannelsIn * kChannelsOut;
  static constexpr std::size_t kParameters = kWeights + kChannelsOut;
  static constexpr long kMacs = 1L * kColumns * kColumns * kWeights;  // including those with the padding
  // Those that convolve() of `kernels` executes. Where it is not used, the products with the padding are left
  // out.
  static long macs_done(const Kernels<N>& kernels, bool averages) {
    const bool is_pooled = averages ? of_this_shape(kernels.average_pooled_convolution) != nullptr
                                    : of_this_shape(kernels.max_pooled_convolution) != nullptr;
    const bool spares_rows = is_pooled || kColumns % kernels.pixels == 0;
    const bool spares_columns = is_pooled || (spares_rows && kernels.skips_zeros);
    const int padded = kColumns == kSide ? 2 : 1;  // rows or columns beside the padding
    const int rows = 3 * kColumns - (spares_rows ? padded : 0);
    const int columns = 3 * kColumns - (spares_columns ? padded : 0);
    return 1L * rows * columns * kChannelsIn * kChannelsOut;
  }
  using Weights = LayerWeights<N, kWeights, kChannelsOut>;
  using Input = PaddedImage<ConvInput<N>, kSide, kChannelsIn>;
  // Scratch: two rows, or what a pooled convolution needs.
  static constexpr int kTwoRows = 2 * kColumns * kChannelsOut;
  using Sums = std::array<Sum<N>, N::kIsInteger ? max(kTwoRows, kPooledConvolutionScratch) : kTwoRows>;

  // Max pooling: the activation of the largest sum of each window. `sums`: scratch, aligned to 64 bytes.
  using MaxPooled = PaddedImage<ConvInput<N>, kSideOut, kChannelsOut>;
  [[gnu::noinline]] static void forward(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                        Sums& sums, MaxPooled& out) {
    out.values.fill({});
    if (convolves_and_pools<ConvInput<N>>(kernels.max_pooled_convolution, weights, in, sums, out.row(0),
                                          MaxPooled::kRow))
      return;
    for (int y = 0; y < kSideOut; ++y) {
      two_rows(kernels, weights, in, y, sums);
      kernels.max_pool(sums.data(), kColumns, kChannelsOut, weights.shift.data(), out.row(y));
    }
  }

  // Average pooling: the mean of the four activations of each window; in fixed point their sum, which is
  // exact.
  using AveragePooled = std::array<DenseInput<N>, kSideOut * kSideOut * kChannelsOut>;
  [[gnu::noinline]] static void forward(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                        Sums& sums, AveragePooled& out) {
    constexpr int kRow = kSideOut * kChannelsOut;
    if (convolves_and_pools<DenseInput<N>>(kernels.average_pooled_convolution, weights, in, sums, out.data(),
                                           kRow))
      return;
    for (int y = 0; y < kSideOut; ++y) {
      two_rows(kernels, weights, in, y, sums);
      kernels.average_pool(sums.data(), kColumns, kChannelsOut, weights.shift.data(), out.data() + y * kRow);
    }
  }

 private:
  static constexpr int kStrips = 3;

  static constexpr ImageShape kImage{kSide, kChannelsIn, kChannelsOut};

  template <class Out>
  using PooledConvolutionOf = PooledConvolution<N, Out>*(const ImageShape& shape);
  // nullptr: there is none.
  template <class Out>
  static PooledConvolution<N, Out>* of_this_shape(PooledConvolutionOf<Out>* convolution_of) {
    return convolution_of != nullptr ? convolution_of(kImage) : nullptr;
  }
  // False: no kernel does both for this layer.
  template <class Out>
  static bool convolves_and_pools(PooledConvolutionOf<Out>* convolution_of, const Weights& weights,
                                  const Input& in, Sums& sums, Out* out, int out_row) {
    if constexpr (N::kIsInteger) {
      if (auto* const convolution = of_this_shape<Out>(convolution_of)) {
        convolution(kImage, in.values.data(), weights.bias.data(), weights.weight.data(),
                    weights.shift.data(), out, out_row, sums.data());
        return true;
      }
    }
    return false;
  }
  static constexpr ProductShape shape_of(int rows, int strips) {
    return {rows,        kColumns,
            Input::kRow, kChannelsIn,
            strips,      3 * kChannelsIn,
            Input::kRow, kChannelsOut,
            kChannelsIn, kColumns == kSide ? kChannelsIn : 0};
  }

  // Sums of rows 2 y and 2 y + 1. If rows can be computed one at a time at no cost, the first row skips the
  // padding above and the last row the padding below.
  static void two_rows(const Kernels<N>& kernels, const Weights& weights, const Input& in, int y,
                       Sums& sums) {
    const bool skips_padding = kColumns % kernels.pixels == 0;
    const int above = skips_padding && y == 0 ? 1 : 0;
    const int below = skips_padding && 2 * y + 2 == kSide ? 1 : 0;
    if (above + below == 0) {
      rows(kernels, weights, in, 2 * y, 2, 0, kStrips, sums.data());
      return;
    }
    rows(kernels, weights, in, 2 * y, 1, above, kStrips - above, sums.data());
    rows(kernels, weights, in, 2 * y + 1, 1, 0, kStrips - below, sums.data() + kColumns * kChannelsOut);
  }

  // Sums of `count` rows starting at row `first`, over `strips` strips (ky) starting at `first_strip`.
  static void rows(const Kernels<N>& kernels, const Weights& weights, const Input& in, int first, int count,
                   int first_strip, int strips, Sum<N>* sums) {
    kernels.convolve(shape_of(count, strips), in.values.data() + (first + first_strip) * Input::kRow,
                     weights.bias.data(),
                     weights.weight.data() + first_strip * 3 * kChannelsIn * kChannelsOut, sums);
  }
};

}  // namespace tumblesight::gnc
