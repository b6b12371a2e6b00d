// Dense: fully connected layer with bias, from kIn inputs to kOut outputs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/nn/kernels/kernels.hpp"
#include "gnc/nn/kernels/numerics.hpp"

namespace tumblesight::gnc {

// N: Float32 or FixedPoint. Order of summation of an output: bias, then inputs ascending. In fixed point
// inputs are int16, weights int8, sums int32; the weights have outputs up to a multiple of kIntegerChannels,
// kPaddedOut.
template <class N, int kIn, int kOut>
struct Dense {
  using Product = typename N::DenseProduct;
  static constexpr std::int64_t kLargestSum = INT32_MAX;  // in fixed point: magnitude, rounding included
  static constexpr int kPaddedOut = N::padded(kOut);
  static constexpr std::size_t kParameters = (kIn + 1) * kOut;
  static constexpr long kMacs = 1L * kIn * kOut;
  using Weights = LayerWeights<N, kIn * kPaddedOut, kOut>;
  using Input = std::array<DenseInput<N>, kIn>;
  using Sums = std::array<Sum<N>, kPaddedOut>;

  // The sums before the activation.
  static void sum(const Kernels<N>& kernels, const Weights& weights, const Input& in, Sums& sums) {
    constexpr ProductShape kShape{1, 1, 0, 0, 1, kIn, 0, kPaddedOut};
    kernels.multiply(kShape, in.data(), weights.bias.data(), weights.weight.data(), sums.data());
  }

  // Hidden layer: ReLU; in fixed point requantized to 0..32767 with a shift of 1..30 per output.
  using Hidden = std::array<DenseInput<N>, kOut>;
  [[gnu::noinline]] static void hidden(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                       Sums& sums, Hidden& out) {
    sum(kernels, weights, in, sums);
    for (int c = 0; c < kOut; ++c) activate(sums[c], N::kIsInteger ? weights.shift.data()[c] : 0, out[c]);
  }

  // Last layer: no activation; in fixed point the sum / 2^shift as Fixed, with a shift of 1..62 per output.
  using Output = std::array<typename N::Real, kOut>;
  [[gnu::noinline]] static void output(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                       Sums& sums, Output& out) {
    sum(kernels, weights, in, sums);
    for (int c = 0; c < kOut; ++c) out[c] = to_real(sums[c], N::kIsInteger ? weights.shift.data()[c] : 0);
  }
};

}  // namespace tumblesight::gnc
