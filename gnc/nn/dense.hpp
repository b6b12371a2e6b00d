// Dense: fully connected layer with bias.
#pragma once

#include <array>
#include <cstddef>

#include "gnc/nn/kernels.hpp"
#include "gnc/nn/numerics.hpp"

namespace tumblesight::gnc {

// Summation per output: bias, then inputs ascending.
template <class N, int kIn, int kOut>
struct Dense {
  static constexpr int kPaddedOut = N::padded(kOut);
  static constexpr std::size_t kParameters = (kIn + 1) * kOut;
  static constexpr long kMacs = 1L * kIn * kOut;
  using Weights = LayerWeights<N, kIn * kPaddedOut, kOut>;
  using Input = std::array<DenseInput<N>, kIn>;
  using Sums = std::array<Sum<N>, kPaddedOut>;

  static void sum(const Kernels<N>& kernels, const Weights& weights, const Input& in, Sums& sums) {
    constexpr ProductShape kShape{1, 1, 0, 0, 1, kIn, 0, kPaddedOut};
    kernels.multiply(kShape, in.data(), weights.bias.data(), weights.weight.data(), sums.data());
  }

  // Hidden layer: ReLU.
  using Hidden = std::array<DenseInput<N>, kOut>;
  [[gnu::noinline]] static void hidden(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                       Sums& sums, Hidden& out) {
    sum(kernels, weights, in, sums);
    for (int c = 0; c < kOut; ++c) activate(sums[c], N::kIsInteger ? weights.shift.data()[c] : 0, out[c]);
  }

  // Last layer: numbers with a meaning.
  using Output = std::array<typename N::Real, kOut>;
  [[gnu::noinline]] static void output(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                       Sums& sums, Output& out) {
    sum(kernels, weights, in, sums);
    for (int c = 0; c < kOut; ++c) out[c] = to_real(sums[c], N::kIsInteger ? weights.shift.data()[c] : 0);
  }
};

}  // namespace tumblesight::gnc
