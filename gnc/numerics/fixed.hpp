// Fixed: a real number as a 32-bit integer, format Q7.24. The attitude algebra uses it where no floating
// point is allowed. Specification: docs/numerics.md.
#pragma once

#include <cstdint>

#include "gnc/numerics/division.hpp"
#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {

// Range: |value| <= 128 - 2^-24, symmetric. Every operation saturates to it and rounds once, to the nearest,
// halves up. The results are the same on every processor, since they are defined on two's complement integers
// of 32 and 64 bits.
class Fixed {
 public:
  static constexpr int kFractionBits = 24;
  static constexpr std::int32_t kLargestRaw = 0x7FFFFFFF;

  constexpr Fixed() = default;
  // For constants that the compiler evaluates. Rounds to the nearest, halves away from zero.
  explicit constexpr Fixed(double value)
      : raw_(saturate(static_cast<std::int64_t>(value * kOne + (value < 0.0 ? -0.5 : 0.5)))) {}
  // The number raw / 2^24, saturated.
  static constexpr Fixed from_raw(std::int64_t raw) {
    Fixed fixed;
    fixed.raw_ = saturate(raw);
    return fixed;
  }
  constexpr std::int32_t raw() const { return raw_; }

  friend constexpr Fixed operator+(Fixed a, Fixed b) { return from_raw(std::int64_t{a.raw_} + b.raw_); }
  friend constexpr Fixed operator-(Fixed a, Fixed b) { return from_raw(std::int64_t{a.raw_} - b.raw_); }
  friend constexpr Fixed operator-(Fixed a) { return from_raw(-std::int64_t{a.raw_}); }
  friend constexpr Fixed operator*(Fixed a, Fixed b) { return from_product(std::int64_t{a.raw_} * b.raw_); }
  // Division by zero gives the largest number with the sign of the dividend.
  friend constexpr Fixed operator/(Fixed a, Fixed b) {
    const std::int64_t at_zero = select<std::int64_t>(a.raw_ < 0, -kLargestRaw, kLargestRaw);
    const std::int64_t divisor = select<std::int64_t>(b.raw_ == 0, 1, abs<std::int64_t>(b.raw_));
    const std::int64_t dividend =
        select<std::int64_t>(b.raw_ < 0, -std::int64_t{a.raw_}, a.raw_) * (2 * kOne);
    const std::int64_t truncated = divide(dividend, divisor);
    const std::int64_t floor = truncated + less_mask(dividend, truncated * divisor);
    return from_raw(select(b.raw_ == 0, at_zero, (floor + 1) >> 1));
  }
  constexpr Fixed& operator+=(Fixed b) { return *this = *this + b; }
  constexpr Fixed& operator*=(Fixed b) { return *this = *this * b; }

  friend constexpr bool operator<(Fixed a, Fixed b) { return is_less(a.raw_, b.raw_); }
  friend constexpr bool operator>(Fixed a, Fixed b) { return is_less(b.raw_, a.raw_); }
  friend constexpr bool operator==(Fixed a, Fixed b) { return a.raw_ == b.raw_; }
  friend constexpr bool operator!=(Fixed a, Fixed b) { return a.raw_ != b.raw_; }

  // a0 b0 + a1 b1 + a2 b2, rounded once at the end. The sum of the first two products saturates at +-2^13.
  static constexpr Fixed dot(Fixed a0, Fixed b0, Fixed a1, Fixed b1, Fixed a2, Fixed b2) {
    const std::int64_t two = std::int64_t{a0.raw_} * b0.raw_ + std::int64_t{a1.raw_} * b1.raw_;
    return from_product(with_headroom(two) + std::int64_t{a2.raw_} * b2.raw_);
  }

 private:
  static constexpr std::int64_t kOne = std::int64_t{1} << kFractionBits;
  static_assert((std::int64_t{-3} >> 1) == -2, "right shifts must be arithmetic");

  static constexpr std::int32_t saturate(std::int64_t raw) {
    if constexpr (kHasConditionalMoves)
      return static_cast<std::int32_t>(clamp<std::int64_t>(raw, -kLargestRaw, kLargestRaw));
    // By its words, in half as many instructions of 32 bits. A negative number fits if the number below it
    // does.
    const std::uint32_t sign = static_cast<std::uint32_t>(raw >> 63);
    const Words farther(static_cast<std::uint64_t>(raw) + static_cast<std::uint64_t>(raw >> 63));
    const std::uint32_t lost = farther.high ^ (0U - (farther.low >> 31));
    const std::uint32_t does_not_fit = 0U - ((lost | (0U - lost)) >> 31);
    const std::uint32_t limit = (std::uint32_t{kLargestRaw} ^ sign) - sign;
    const auto low = static_cast<std::uint32_t>(raw);
    return static_cast<std::int32_t>(low ^ ((low ^ limit) & does_not_fit));
  }
  static constexpr Fixed from_product(std::int64_t product) {
    return from_raw((product + (kOne >> 1)) >> kFractionBits);
  }
  // Keeps the sum of two raw products low enough for a third product, below 2^62, to be added without
  // overflow.
  static constexpr std::int64_t with_headroom(std::int64_t sum) {
    constexpr std::int64_t kBound = std::int64_t{1} << 61;
    if constexpr (kHasConditionalMoves) return clamp(sum, -kBound, kBound);
    // By the high word: from +-2^61 on the low one is 0.
    constexpr std::int32_t kHighBound = 1 << 29;
    const auto high = static_cast<std::int32_t>(sum >> 32);
    const std::int32_t sign = sign_mask(high);
    const std::int32_t is_beyond = sign_mask(kHighBound - 1 - (high ^ sign));
    const std::int32_t limited = high ^ ((high ^ ((kHighBound ^ sign) - sign)) & is_beyond);
    const std::uint32_t low = static_cast<std::uint32_t>(sum) & ~static_cast<std::uint32_t>(is_beyond);
    return (std::int64_t{limited} * (std::int64_t{1} << 32)) | low;
  }

  std::int32_t raw_ = 0;
};

// `yes` or `no`, without a branch.
constexpr Fixed select(bool condition, Fixed yes, Fixed no) {
  return Fixed::from_raw(select(condition, yes.raw(), no.raw()));
}

}  // namespace tumblesight::gnc
