// The two numerics in which the network exists: a policy of its layers' types. Float32 is the reference,
// FixedPoint flies; docs/numerics.md is the norm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "gnc/nn/product.hpp"
#include "gnc/numerics/fixed.hpp"

namespace tumblesight::gnc {

// (sum + 2^(shift - 1)) >> shift: to the nearest, halves up. The one rounding between a layer's sum and the
// next layer's input. 1 <= shift; sum + 2^(shift - 1) does not overflow, model_image.hpp sees to it.
inline std::int32_t requantised(std::int32_t sum, int shift) {
  return (sum + (std::int32_t{1} << (shift - 1))) >> shift;
}

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

  // Read in place, where the model image lies.
  template <std::size_t kWeights>
  class Weights {
   public:
    static constexpr std::size_t size() { return kWeights; }
    const std::int8_t* data() const { return data_; }
    void lie_at(const std::int8_t* data) { data_ = data; }

   private:
    const std::int8_t* data_ = nullptr;
  };
  template <int kOut>
  using Shifts = std::array<std::uint8_t, kOut>;
};

template <class N>
using ConvInput = typename N::ConvProduct::Input;
template <class N>
using DenseInput = typename N::DenseProduct::Input;
template <class N>
using Sum = typename N::DenseProduct::Sum;

// One layer's parameters: the sums' weights and start, and in fixed point each channel's shift.
template <class N, std::size_t kWeights, int kOut>
struct LayerWeights {
  static constexpr int kPaddedOut = N::padded(kOut);
  static constexpr int kShifts = N::kIsInteger ? kPaddedOut : 0;
  static constexpr std::size_t kBytesInImage =
      kWeights * sizeof(typename N::DenseProduct::Weight) + 4U * (kPaddedOut + kShifts);
  alignas(64) typename N::template Weights<kWeights> weight{};
  alignas(64) std::array<Sum<N>, kPaddedOut> bias{};
  typename N::template Shifts<kPaddedOut> shift{};
};

// Held between 0 and `largest`.
inline std::int32_t saturated(std::int32_t value, std::int32_t largest) {
  if constexpr (kMovesConditionally) return clamp(value, 0, largest);
  const std::int32_t not_negative = value & ~(value >> 31);
  const std::int32_t room = largest - not_negative;
  return not_negative + (room & (room >> 31));
}

// The larger of two sums of a convolution, which model_image.hpp holds below this: so their difference has
// its true sign.
inline constexpr std::int32_t kLargestConvolved = 1 << 30;
inline float larger_convolved(float a, float b) {
  return max(a, b);
}
inline std::int32_t larger_convolved(std::int32_t a, std::int32_t b) {
  if constexpr (kMovesConditionally) return max(a, b);
  const std::int32_t more = b - a;
  return a + (more & ~(more >> 31));
}

// Activation: ReLU and, in fixed point, requantisation with saturation. NaN gives 0.
inline void activate(float sum, int, float& out) {
  out = select(sum > 0.0F, sum, 0.0F);
}
inline void activate(std::int32_t sum, int shift, std::uint8_t& out) {
  out = static_cast<std::uint8_t>(saturated(requantised(sum, shift), 255));
}
inline void activate(std::int32_t sum, int shift, std::int16_t& out) {
  out = static_cast<std::int16_t>(saturated(requantised(sum, shift), 32767));
}

// The mean of four numbers, activated; in fixed point their sum, which loses nothing, each of at most 12
// bits.
inline constexpr int kLargestOfFour = 4095;
inline void activate_four(const float (&sums)[4], int, float& out) {
  float total = 0.0F;
  for (const float sum : sums) total += select(sum > 0.0F, sum, 0.0F);
  out = total / 4.0F;
}
inline void activate_four(const std::int32_t (&sums)[4], int shift, std::int16_t& out) {
  std::int32_t total = 0;
  for (const std::int32_t sum : sums) total += saturated(requantised(sum, shift), kLargestOfFour);
  out = static_cast<std::int16_t>(total);
}

// What leaves the network as a number with a meaning: (sum 2^24 + 2^(shift - 1)) >> shift.
inline float to_real(float sum, int) {
  return sum;
}
inline Fixed to_real(std::int32_t sum, int shift) {
  return Fixed::from_raw(
      (std::int64_t{sum} * (1 << Fixed::kFractionBits) + (std::int64_t{1} << (shift - 1))) >> shift);
}

// The other way: 15 bits behind the point, saturating. A product is rounded once.
inline void to_input(float value, float& input) {
  input = value;
}
inline std::int16_t saturated_q15(std::int64_t value) {
  return static_cast<std::int16_t>(clamp<std::int64_t>(value, -32767, 32767));
}
inline void to_input(Fixed value, std::int16_t& input) {
  constexpr int kShift = Fixed::kFractionBits - 15;
  input = saturated_q15((std::int64_t{value.raw()} + (1 << (kShift - 1))) >> kShift);
}
inline void to_input(Fixed a, Fixed b, std::int16_t& input) {
  constexpr int kShift = 2 * Fixed::kFractionBits - 15;
  input = saturated_q15((std::int64_t{a.raw()} * b.raw() + (std::int64_t{1} << (kShift - 1))) >> kShift);
}

}  // namespace tumblesight::gnc
