// Lstm: one step of a long short-term memory layer with explicit state (Hochreiter 1997, with forget gate).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/nn/kernels/kernels.hpp"
#include "gnc/nn/kernels/numerics.hpp"

namespace tumblesight::gnc {

// Bound on the cells. A cell changes by less than 1 per step, so the bound takes effect only after 64
// steps of one sign, when tanh has long been flat, or after a bit flip has left a huge value or NaN.
inline constexpr float kLstmCellBound = 64.0F;

// Updates the state from the sums of the gates: c = forget * c + input * cell, h = output * tanh(c).
// Afterwards |h| <= 1 and |c| <= kLstmCellBound, whatever the arguments.
//
// gates  4 * hidden sums before activation, in the order input, forget, cell, output;
//        the float version overwrites them
// shift  fixed point: 4 * hidden shifts of 1..62, the value of a sum is sum / 2^shift; float: not used
// h      hidden state, `hidden` values; int16 in Q0.15
// c      cells, `hidden` values
void lstm_update(float* gates, const std::uint8_t* shift, int hidden, float* h, float* c);
void lstm_update(const std::int32_t* gates, const std::uint8_t* shift, int hidden, std::int16_t* h, Fixed* c);

// sigmoid and tanh of the gates in fixed point: 512 linear segments over [0, 16), constant beyond. Error at
// most 1.3e-5 and 2.6e-5.
Fixed gate_sigmoid(Fixed x);
Fixed gate_tanh(Fixed x);

// N: Float32 or FixedPoint; kIn inputs (int16 in fixed point), kHidden units.
template <class N, int kIn, int kHidden>
struct Lstm {
  using Product = typename N::DenseProduct;
  static constexpr std::int64_t kLargestSum = INT32_MAX;  // in fixed point: magnitude, rounding included
  static constexpr int kGates = 4 * kHidden;
  static_assert(N::padded(kGates) == kGates);
  static constexpr std::size_t kParameters = (kIn + kHidden + 1) * kGates;
  static constexpr long kMacs = 1L * (kIn + kHidden) * kGates;
  using Input = std::array<DenseInput<N>, kIn>;
  using Sums = std::array<Sum<N>, kGates>;  // scratch

  struct State {
    std::array<DenseInput<N>, kHidden> h{};  // Q0.15 in fixed point
    std::array<typename N::Real, kHidden> c{};
  };
  // The base class holds the weights of the input. `recurrent` holds those of the hidden state,
  // [hidden][gates]; both products are added to the same sums and have the same scale.
  struct Weights : LayerWeights<N, kIn * kGates, kGates> {
    using Forward = LayerWeights<N, kIn * kGates, kGates>;
    static constexpr std::size_t kBytesInImage =
        Forward::kBytesInImage + kHidden * kGates * sizeof(typename N::DenseProduct::Weight);
    alignas(64) typename N::template Weights<kHidden * kGates> recurrent{};
  };

  // One step; updates `state`. Order of summation per gate: bias, inputs ascending, then hidden units
  // ascending.
  [[gnu::noinline]] static void forward(const Kernels<N>& kernels, const Weights& weights, const Input& in,
                                        Sums& sums, State& state) {
    constexpr ProductShape kFromInput{1, 1, 0, 0, 1, kIn, 0, kGates};
    constexpr ProductShape kFromHidden{1, 1, 0, 0, 1, kHidden, 0, kGates};
    kernels.multiply(kFromInput, in.data(), weights.bias.data(), weights.weight.data(), sums.data());
    kernels.multiply(kFromHidden, state.h.data(), sums.data(), weights.recurrent.data(), sums.data());
    if constexpr (N::kIsInteger && kHidden % kIntegerChannels == 0) {
      if (kernels.update_lstm != nullptr) {
        kernels.update_lstm(sums.data(), weights.shift.data(), kHidden, state.h.data(), state.c.data());
        return;
      }
    }
    lstm_update(sums.data(), weights.shift.data(), kHidden, state.h.data(), state.c.data());
  }
};

}  // namespace tumblesight::gnc
