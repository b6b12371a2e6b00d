// The two numerics of the network, as policy classes from which the layers take their types, and the rounding
// between the layers. Float32 is the reference, FixedPoint flies. Specification: docs/numerics.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/nn/kernels/product.hpp"
#include "gnc/numerics/fixed.hpp"

namespace tumblesight::gnc {

// (sum + 2^(shift - 1)) >> shift: to the nearest, halves up. The only rounding between the sum of a layer and
// the input of the next. Requires shift >= 1 and that sum + 2^(shift - 1) does not overflow; the check of the
// model image ensures both.
inline std::int32_t requantize(std::int32_t sum, int shift) {
  return (sum + (std::int32_t{1} << (shift - 1))) >> shift;
}

// A policy N defines: Real, the type of physical values; ConvProduct and DenseProduct, the number types of
// the layers (product.hpp); padded(channels), the number of output channels that are stored; Weights and
// Shifts, the containers of a layer's parameters.
struct Float32 {
  static constexpr const char* kName = "float32";
  static constexpr bool kIsInteger = false;
  using Real = float;
  using ConvProduct = Float32Product;
  using DenseProduct = Float32Product;
  static constexpr int padded(int channels) { return channels; }

  template <std::size_t kWeights>
  using Weights = std::array<float, kWeights>;
  template <int kOut>
  struct Shifts {
    static constexpr const std::uint8_t* data() { return nullptr; }
  };
};

struct FixedPoint {
  static constexpr const char* kName = "fixed point";
  static constexpr bool kIsInteger = true;
  using Real = Fixed;
  using ConvProduct = Int8Product;
  using DenseProduct = Int16Product;
  static constexpr int padded(int channels) {
    return (channels + kIntegerChannels - 1) / kIntegerChannels * kIntegerChannels;
  }

  // Weights are read in place from the model image.
  template <std::size_t kWeights>
  class Weights {
   public:
    static constexpr std::size_t size() { return kWeights; }
    const std::int8_t* data() const { return data_; }
    void set_data(const std::int8_t* data) { data_ = data; }

   private:
    const std::int8_t* data_ = nullptr;
  };
  template <int kOut>
  using Shifts = std::array<std::uint8_t, kOut>;
};

// Inputs of convolutions: float or uint8. Inputs of dense layers and the LSTM: float or int16. Sums: float or
// int32.
template <class N>
using ConvInput = typename N::ConvProduct::Input;
template <class N>
using DenseInput = typename N::DenseProduct::Input;
template <class N>
using Sum = typename N::DenseProduct::Sum;

// Parameters of a layer: weights, bias (the start of the sums) and, in fixed point, a shift per output
// channel.
template <class N, std::size_t kWeights, int kOut>
struct LayerWeights {
  static constexpr int kPaddedOut = N::padded(kOut);
  static constexpr int kShifts = N::kIsInteger ? kPaddedOut : 0;
  // The weights, then a bias and a shift (fixed point) of 4 bytes each per stored channel.
  static constexpr std::size_t kBytesInImage =
      kWeights * sizeof(typename N::DenseProduct::Weight) + 4U * (kPaddedOut + kShifts);
  alignas(64) typename N::template Weights<kWeights> weight{};
  alignas(64) std::array<Sum<N>, kPaddedOut> bias{};
  typename N::template Shifts<kPaddedOut> shift{};
};

// `value` limited to [0, largest].
inline std::int32_t saturate(std::int32_t value, std::int32_t largest) {
  if constexpr (kHasConditionalMoves) return clamp(value, 0, largest);
  const std::int32_t not_negative = value & ~(value >> 31);
  const std::int32_t room = largest - not_negative;
  return not_negative + (room & (room >> 31));
}

// The larger of two sums of a convolution. The check of the model image ensures that their magnitude is below
// kMaxConvSum, so their difference does not overflow.
inline constexpr std::int32_t kMaxConvSum = 1 << 30;
inline float max_conv_sum(float a, float b) {
  return max(a, b);
}
inline std::int32_t max_conv_sum(std::int32_t a, std::int32_t b) {
  if constexpr (kHasConditionalMoves) return max(a, b);
  const std::int32_t difference = b - a;
  return a + (difference & ~(difference >> 31));
}

// Activation: ReLU; in fixed point requantized and saturated to uint8 (0..255) or int16 (0..32767). NaN gives
// 0.
inline void activate(float sum, int, float& out) {
  out = select(sum > 0.0F, sum, 0.0F);
}
inline void activate(std::int32_t sum, int shift, std::uint8_t& out) {
  out = static_cast<std::uint8_t>(saturate(requantize(sum, shift), 255));
}
inline void activate(std::int32_t sum, int shift, std::int16_t& out) {
  out = static_cast<std::int16_t>(saturate(requantize(sum, shift), 32767));
}

// Average pooling: the mean of the four activations; in fixed point their exact sum, each activation limited
// to 12 bits.
inline constexpr int kMaxAveragedActivation = 4095;
inline void activate_and_average(const float (&sums)[4], int, float& out) {
  float total = 0.0F;
  for (const float sum : sums) total += select(sum > 0.0F, sum, 0.0F);
  out = total / 4.0F;
}
inline void activate_and_average(const std::int32_t (&sums)[4], int shift, std::int16_t& out) {
  std::int32_t total = 0;
  for (const std::int32_t sum : sums) total += saturate(requantize(sum, shift), kMaxAveragedActivation);
  out = static_cast<std::int16_t>(total);
}

// Output of the network in physical units. Fixed point: sum / 2^shift, to the nearest, halves up, saturated;
// shift 1..62.
inline float to_real(float sum, int) {
  return sum;
}
inline Fixed to_real(std::int32_t sum, int shift) {
  return Fixed::from_raw(
      (std::int64_t{sum} * (1 << Fixed::kFractionBits) + (std::int64_t{1} << (shift - 1))) >> shift);
}

// Input of a dense layer or LSTM from a real number. Fixed point: Q0.15, to the nearest, halves up, saturated
// to +-32767. The overload with two factors rounds their product once.
inline void to_input(float value, float& input) {
  input = value;
}
inline std::int16_t saturate_q15(std::int64_t value) {
  return static_cast<std::int16_t>(clamp<std::int64_t>(value, -32767, 32767));
}
inline void to_input(Fixed value, std::int16_t& input) {
  constexpr int kShift = Fixed::kFractionBits - 15;
  input = saturate_q15((std::int64_t{value.raw()} + (1 << (kShift - 1))) >> kShift);
}
inline void to_input(Fixed a, Fixed b, std::int16_t& input) {
  constexpr int kShift = 2 * Fixed::kFractionBits - 15;
  input = saturate_q15((std::int64_t{a.raw()} * b.raw() + (std::int64_t{1} << (kShift - 1))) >> kShift);
}

}  // namespace tumblesight::gnc
