// Lstm: one step of a long short-term memory layer with explicit state.
#pragma once

#include <array>
#include <cstddef>

#include "gnc/nn/sliding_product.hpp"

namespace tumblesight::gnc {

// Bound on the cells. A cell moves by less than 1 a step, so it takes effect only after that many steps of
// one sign (tanh has long been flat by then) or when a bit flip left something huge or NaN behind.
inline constexpr float kLstmCellBound = 64.0F;

// `gates` (4 * hidden, order input, forget, cell, output, before their activations; overwritten) and the
// cells make the new state: c = forget * c + input * cell, h = output * tanh(c). |h| <= 1 and |c| <=
// kLstmCellBound always.
void lstm_update(float* gates, int hidden, float* h, float* c);

template <int kIn, int kHidden>
struct Lstm {
  static constexpr int kGates = 4 * kHidden;
  using Input = std::array<float, kIn>;
  using Gates = std::array<float, kGates>;  // scratch

  struct State {
    std::array<float, kHidden> h{};
    std::array<float, kHidden> c{};
  };
  struct Weights {
    alignas(64) std::array<float, kIn * kGates> input{};          // [in][gate order i, f, g, o][hidden]
    alignas(64) std::array<float, kHidden * kGates> recurrent{};  // [hidden][gates]
    alignas(64) std::array<float, kGates> bias{};
  };
  static constexpr std::size_t kParameters = (kIn + kHidden + 1) * kGates;

  // Summation per gate: bias, inputs ascending, then hidden units ascending.
  static void forward(const Weights& weights, const Input& in, Gates& gates, State& state) {
    constexpr SlidingProductShape kFromInput{1, 1, 0, 0, 1, kIn, 0, kGates};
    constexpr SlidingProductShape kFromHidden{1, 1, 0, 0, 1, kHidden, 0, kGates};
    sliding_product(kFromInput, in.data(), weights.bias.data(), weights.input.data(), gates.data());
    sliding_product(kFromHidden, state.h.data(), gates.data(), weights.recurrent.data(), gates.data());
    lstm_update(gates.data(), kHidden, state.h.data(), state.c.data());
  }
};

}  // namespace tumblesight::gnc
