// Choices without branches: the same instructions whatever is chosen, so that the time of a step does not
// depend on the data. Compilers are free to turn `condition ? yes : no` into a jump; they leave masks alone.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tumblesight::gnc {

// All ones or all zeros.
template <class Integer>
constexpr Integer mask_of(bool condition) {
  return static_cast<Integer>(-static_cast<Integer>(condition));
}

// Of the first argument's type: int and std::int32_t are different ones on some processors.
template <class Number>
using SameAs = std::common_type_t<Number>;

template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
constexpr Integer select(bool condition, Integer yes, SameAs<Integer> no) {
  return static_cast<Integer>(no ^ ((yes ^ no) & mask_of<Integer>(condition)));
}
inline float select(bool condition, float yes, float no) {
  std::uint32_t yes_bits = 0, no_bits = 0;
  std::memcpy(&yes_bits, &yes, sizeof yes);
  std::memcpy(&no_bits, &no, sizeof no);
  const std::uint32_t bits = select(condition, yes_bits, no_bits);
  std::memcpy(&yes, &bits, sizeof yes);
  return yes;
}

// All ones where a < b. Without a comparison, which some processors can only make with a jump.
template <class Integer>
constexpr Integer less_mask(Integer a, SameAs<Integer> b) {
  static_assert(std::is_integral_v<Integer>);
  if constexpr (sizeof(Integer) < 8) {
    return static_cast<Integer>((static_cast<std::int64_t>(a) - static_cast<std::int64_t>(b)) >> 63);
  } else {
    // The difference's sign, or its borrow; where that would overflow, or not, the operands tell.
    const auto x = static_cast<std::uint64_t>(a), y = static_cast<std::uint64_t>(b);
    const std::uint64_t first = std::is_signed_v<Integer> ? x & ~y : ~x & y;
    const std::uint64_t borrow = first | (~(x ^ y) & (x - y));
    return static_cast<Integer>(static_cast<std::int64_t>(borrow) >> 63);
  }
}

// Where there are conditional moves, compilers use them, and comparisons are as good as masks.
#if defined(__x86_64__) || defined(__aarch64__)
inline constexpr bool kMovesConditionally = true;
#else
inline constexpr bool kMovesConditionally = false;
#endif

template <class Integer>
constexpr bool is_less(Integer a, SameAs<Integer> b) {
  if constexpr (kMovesConditionally)
    return a < b;
  else
    return (less_mask<Integer>(a, b) & 1) != 0;
}

template <class Number>
constexpr Number min(Number a, SameAs<Number> b) {
  if constexpr (!std::is_integral_v<Number>)
    return select(b < a, b, a);
  else if constexpr (kMovesConditionally)
    return b < a ? b : a;
  else
    return static_cast<Number>(a ^ ((a ^ b) & less_mask<Number>(b, a)));
}
template <class Number>
constexpr Number max(Number a, SameAs<Number> b) {
  if constexpr (!std::is_integral_v<Number>)
    return select(a < b, b, a);
  else if constexpr (kMovesConditionally)
    return a < b ? b : a;
  else
    return static_cast<Number>(a ^ ((a ^ b) & less_mask<Number>(a, b)));
}
template <class Integer>
constexpr Integer abs(Integer value) {
  const Integer sign = static_cast<Integer>(value >> (8 * sizeof(Integer) - 1));
  return static_cast<Integer>((value ^ sign) - sign);
}
// Held between `low` and `high`; NaN gives `low`.
template <class Number>
constexpr Number clamp(Number value, SameAs<Number> low, SameAs<Number> high) {
  return min<Number>(high, max<Number>(low, value));
}

}  // namespace tumblesight::gnc
