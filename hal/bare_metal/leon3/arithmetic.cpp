// 64-bit division. The compiler calls libgcc for it, but Debian's libgcc is for SPARC V9.
#include "gnc/numerics/division.hpp"

extern "C" {

std::uint64_t __udivdi3(std::uint64_t dividend, std::uint64_t divisor) {
  return tumblesight::gnc::divide_by_reciprocal(dividend, divisor);
}

std::int64_t __divdi3(std::int64_t dividend, std::int64_t divisor) {
  const auto magnitude = [](std::int64_t x) { return static_cast<std::uint64_t>(x < 0 ? -x : x); };
  const auto quotient = static_cast<std::int64_t>(__udivdi3(magnitude(dividend), magnitude(divisor)));
  return (dividend < 0) != (divisor < 0) ? -quotient : quotient;
}

}  // extern "C"
