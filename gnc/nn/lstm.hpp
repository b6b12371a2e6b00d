// Lstm: one step of a long short-term memory layer with explicit state.
#pragma once

#include <array>
#include <cstddef>

#include "gnc/nn/kernels.hpp"
#include "gnc/nn/numerics.hpp"

namespace tumblesight::gnc {

// Bound on the cells. A cell moves by less than 1 a step, so it takes effect only after that many steps of
// one sign (tanh has long been flat by then) or when a bit flip left something huge or NaN behind.
inline constexpr float kLstmCellBound = 64.0F;

// `gates` (4 * hidden sums, order input, forget, cell, output, before their activations; floats are
// overwritten) and the cells make the new state: c = forget * c + input * cell, h = output * tanh(c). |h| <=
// 1 and |c| <= kLstmCellBound always.
void lstm_update(float* gates, const std::uint8_t* shift, int hidden, float* h, float* c);
void lstm_update(const std::int32_t* gates, const std::uint8_t* shift, int hidden, std::int16_t* h, Fixed* c);

// sigmoid and tanh of the gates in fixed point: 512 straight lines over [0, 16), flat beyond; within 1.3e-5
// and 2.6e-5 of the exact values.
Fixed gate_sigmoid(Fixed x);
Fixed gate_tanh(Fixed x);

template <class N, int kIn, int kHidden>
struct Lstm {
  static constexpr int kGates = 4 * kHidden;
  static_assert(N::padded(kGates) == kGates);
  static constexpr std::size_t kParameters = (kIn + kHidden + 1) * kGates;
  static constexpr long kMacs = 1L * (kIn + kHidden) * kGates;
  using Input = std::array<DenseInput<N>, kIn>;
  using Sums = std::array<Sum<N>, kGates>;  // scratch

  struct State {
    std::array<DenseInput<N>, kHidden> h{};  // in fixed point 15 bits behind the point
    std::array<typename N::Real, kHidden> c{};
  };
  // Of the input; recurrent: [hidden][gates], into the same sums, so of the same scale.
  struct Weights : LayerWeights<N, kIn * kGates, kGates> {
    using Forward = LayerWeights<N, kIn * kGates, kGates>;
    static constexpr std::size_t kBytesInImage =
        Forward::kBytesInImage + kHidden * kGates * sizeof(typename N::DenseProduct::Weight);
    alignas(64) typename N::template Weights<kHidden * kGates> recurrent{};
  };

  // Summation per gate: bias, inputs ascending, then hidden units ascending.
  [[gnu::noinline]] static void forward(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                        Sums& sums, State& state) {
    constexpr ProductShape kFromInput{1, 1, 0, 0, 1, kIn, 0, kGates};
    constexpr ProductShape kFromHidden{1, 1, 0, 0, 1, kHidden, 0, kGates};
    kernels.multiply(kFromInput, in.data(), weights.bias.data(), weights.weight.data(), sums.data());
    kernels.multiply(kFromHidden, state.h.data(), sums.data(), weights.recurrent.data(), sums.data());
    lstm_update(sums.data(), weights.shift.data(), kHidden, state.h.data(), state.c.data());
  }
};

}  // namespace tumblesight::gnc
