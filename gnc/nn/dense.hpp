// Dense: fully connected layer with bias.
#pragma once

#include <array>
#include <cstddef>

#include "gnc/nn/sliding_product.hpp"

namespace tumblesight::gnc {

// Summation per output: bias, then inputs ascending.
template <int kIn, int kOut>
struct Dense {
  using Input = std::array<float, kIn>;
  using Output = std::array<float, kOut>;

  struct Weights {
    alignas(64) std::array<float, kIn * kOut> weight{};  // [in][out]
    alignas(64) std::array<float, kOut> bias{};
  };
  static constexpr std::size_t kParameters = (kIn + 1) * kOut;

  static void forward(const Weights& weights, const Input& in, Output& out) {
    constexpr SlidingProductShape kShape{1, 1, 0, 0, 1, kIn, 0, kOut};
    sliding_product(kShape, in.data(), weights.bias.data(), weights.weight.data(), out.data());
  }
};

}  // namespace tumblesight::gnc
