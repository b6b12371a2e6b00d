// Division of 64-bit integers whose instruction count does not depend on the operands. On 32-bit processors
// the compiler's runtime function for it does depend on them. There the quotient is computed in three digits
// with a reciprocal of the divisor, which takes about 170 instructions.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {

// A number of 64 bits in two words, for shifts by a variable number of bits: compilers may turn those of 64
// bits into jumps.
struct Words {
  std::uint32_t high, low;

  constexpr explicit Words(std::uint64_t value)
      : high(static_cast<std::uint32_t>(value >> 32)), low(static_cast<std::uint32_t>(value)) {}
  constexpr std::uint64_t value() const { return (std::uint64_t{high} << 32) | low; }

  // Shifts left until the highest bit is set, and returns by how many bits. Requires value() > 0.
  constexpr std::uint32_t normalize() {
    const std::uint32_t empty = ~less_mask<std::uint32_t>(0, high);
    high |= low & empty;
    low &= ~empty;
    std::uint32_t shift = empty & 32;
    for (std::uint32_t bits = 16; bits > 0; bits /= 2) {
      const auto top = static_cast<std::int32_t>(high >> (32 - bits));
      const std::uint32_t by = static_cast<std::uint32_t>(sign_mask(top - 1)) & bits;
      high = (high << by) | ((low >> 1) >> (31 - by));
      low <<= by;
      shift += by;
    }
    return shift;
  }
  // bits: 0 to 63.
  constexpr void shift_right(std::uint32_t bits) {
    const std::uint32_t is_far = 0U - (bits >> 5);
    low = (low & ~is_far) | (high & is_far);
    high &= ~is_far;
    const std::uint32_t by = bits & 31;
    low = (low >> by) | ((high << 1) << (31 - by));
    high >>= by;
  }
};

// dividend / divisor. Requires divisor > 0. Not inlined: a copy at every division would cost much code.
//
// With the divisor shifted to D, 2^61 <= D <= 2^62, the quotient dividend / D is below 8. Its first 22 bits,
// then twice 21 bits more, are computed with a reciprocal of D. Every digit is too small by less than 1.4
// units, so that what remains stays below 1.4 D. The quotient sought is the result shifted to its place; it
// is right or too small by one.
[[gnu::noinline]] constexpr std::uint64_t divide_by_reciprocal(std::uint64_t dividend,
                                                               std::uint64_t divisor) {
  const auto high_product = [](std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(a) * b) >> 32);
  };
  Words normalized(divisor);
  const std::uint32_t shift = normalized.normalize();
  // Rounded up where bits are lost.
  const std::uint64_t d = (normalized.value() >> 2) + ((normalized.low | (normalized.low >> 1)) & 1U);
  // 1 / x by Newton's method from 2.914 - 2 x on, Q30, never too large. x: 1/2 to 1, Q31, rounded up.
  const std::uint32_t x = (normalized.high >> 1) + 1;
  std::uint32_t inverse = 0xBA83'0000U - x;
  for (int i = 0; i < 3; ++i) inverse = high_product(inverse, (1U << 30) - high_product(x, inverse)) << 3;
  inverse -= 16;

  std::uint64_t remaining = dividend, quotient = 0;
  constexpr std::array<int, 3> kBits{19, 21, 21};
  for (const int bits : kBits) {
    const std::uint32_t digit =
        high_product(static_cast<std::uint32_t>(remaining >> 32), inverse) >> (28 - bits);
    remaining = (remaining << bits) - digit * d;
    quotient = (quotient << bits) + digit;
  }
  Words placed(quotient);
  placed.shift_right(63 - shift);
  quotient = placed.value();
  return quotient + 1 + less_mask(dividend - quotient * divisor, divisor);
}

// dividend / divisor, truncated toward zero. Requires divisor > 0, and 2 at least for the most negative
// dividend.
constexpr std::int64_t divide(std::int64_t dividend, std::int64_t divisor) {
  if constexpr (sizeof(void*) == 8) return dividend / divisor;
  const auto quotient = static_cast<std::int64_t>(
      divide_by_reciprocal(static_cast<std::uint64_t>(abs(dividend)), static_cast<std::uint64_t>(divisor)));
  const std::int64_t sign = dividend >> 63;
  return (quotient ^ sign) - sign;
}

}  // namespace tumblesight::gnc
