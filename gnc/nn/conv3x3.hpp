// Conv3x3: 3x3 convolution with bias over a square HWC image, zero padding 1, stride 1.
#pragma once

#include <array>
#include <cstddef>

#include "gnc/nn/padding.hpp"
#include "gnc/nn/sliding_product.hpp"

namespace tumblesight::gnc {

// Summation per output: bias, then ky, kx, input channel ascending; padding takes part as zeros.
template <int kSide, int kChannelsIn, int kChannelsOut>
struct Conv3x3 {
  static constexpr int kPaddedSide = kSide + 2;
  using Input = std::array<float, kSide * kSide * kChannelsIn>;
  using Padded = std::array<float, kPaddedSide * kPaddedSide * kChannelsIn>;  // scratch
  using Output = std::array<float, kSide * kSide * kChannelsOut>;

  struct Weights {
    alignas(64) std::array<float, 3 * 3 * kChannelsIn * kChannelsOut> weight{};  // [ky][kx][in][out]
    alignas(64) std::array<float, kChannelsOut> bias{};
  };
  static constexpr std::size_t kParameters = (3 * 3 * kChannelsIn + 1) * kChannelsOut;

  static void forward(const Weights& weights, const Input& in, Padded& padded, Output& out) {
    constexpr int kRow = kPaddedSide * kChannelsIn;
    constexpr SlidingProductShape kShape{kSide, kSide,           kRow, kChannelsIn,
                                         3,     3 * kChannelsIn, kRow, kChannelsOut};
    pad_by_one(in.data(), kSide, kChannelsIn, padded.data());
    sliding_product(kShape, padded.data(), weights.bias.data(), weights.weight.data(), out.data());
  }
};

}  // namespace tumblesight::gnc
