// Division of 64-bit integers whose instruction count does not depend on the operands. On 32-bit processors
// the compiler's runtime function for it does depend on them; there one quotient bit is computed at a time.
#pragma once

#include <cstdint>

#include "gnc/numerics/select.hpp"

namespace tumblesight::gnc {

// dividend / divisor by restoring division, 64 iterations. Requires divisor > 0. Not inlined: a copy at every
// division would cost 4 KiB.
[[gnu::noinline]] constexpr std::uint64_t divide_bit_by_bit(std::uint64_t dividend, std::uint64_t divisor) {
  std::uint64_t quotient = 0;
  std::uint64_t remaining = 0;
  for (int bit = 63; bit >= 0; --bit) {
    remaining = (remaining << 1) | ((dividend >> 63) & 1);
    dividend <<= 1;
    const std::uint64_t fits = ~less_mask(remaining, divisor);
    remaining -= divisor & fits;
    quotient = (quotient << 1) | (fits & 1);
  }
  return quotient;
}

// dividend / divisor, truncated toward zero. Requires divisor > 0.
constexpr std::int64_t divide(std::int64_t dividend, std::int64_t divisor) {
  if constexpr (sizeof(void*) == 8) return dividend / divisor;
  const auto quotient = static_cast<std::int64_t>(
      divide_bit_by_bit(static_cast<std::uint64_t>(abs(dividend)), static_cast<std::uint64_t>(divisor)));
  const std::int64_t sign = dividend >> 63;
  return (quotient ^ sign) - sign;
}

}  // namespace tumblesight::gnc
