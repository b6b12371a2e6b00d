// Selection without branches: the executed instructions do not depend on the data, and neither does the
// time of a step. Compilers may turn `condition ? yes : no` into a jump; they do not do that with masks.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tumblesight::gnc {

// All bits set if `condition`, else 0.
template <class Integer>
constexpr Integer mask_if(bool condition) {
  return static_cast<Integer>(-static_cast<Integer>(condition));
}

// Keeps a parameter out of template argument deduction (C++20: std::type_identity_t), so that it converts to
// the type of the first argument. On some processors int and std::int32_t are different types.
template <class Number>
using NonDeduced = std::common_type_t<Number>;

// `yes` if `condition`, else `no`; for integers and floats (bit for bit, including NaN).
template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
constexpr Integer select(bool condition, Integer yes, NonDeduced<Integer> no) {
  return static_cast<Integer>(no ^ ((yes ^ no) & mask_if<Integer>(condition)));
}
inline float select(bool condition, float yes, float no) {
  std::uint32_t yes_bits = 0, no_bits = 0;
  std::memcpy(&yes_bits, &yes, sizeof yes);
  std::memcpy(&no_bits, &no, sizeof no);
  const std::uint32_t bits = select(condition, yes_bits, no_bits);
  std::memcpy(&yes, &bits, sizeof yes);
  return yes;
}

// All bits set if a < b, else 0. Avoids a comparison instruction, since some processors need a jump to use
// its result.
template <class Integer>
constexpr Integer less_mask(Integer a, NonDeduced<Integer> b) {
  static_assert(std::is_integral_v<Integer>);
  if constexpr (sizeof(Integer) < 4) {
    return static_cast<Integer>((static_cast<std::int32_t>(a) - static_cast<std::int32_t>(b)) >> 31);
  } else if constexpr (sizeof(Integer) < 8) {
    return static_cast<Integer>((static_cast<std::int64_t>(a) - static_cast<std::int64_t>(b)) >> 63);
  } else {
    // The borrow of a - b: decided by the top bits of the operands if they differ, else by that of the
    // difference.
    const auto x = static_cast<std::uint64_t>(a), y = static_cast<std::uint64_t>(b);
    const std::uint64_t first = std::is_signed_v<Integer> ? x & ~y : ~x & y;
    const std::uint64_t borrow = first | (~(x ^ y) & (x - y));
    return static_cast<Integer>(static_cast<std::int64_t>(borrow) >> 63);
  }
}

// All bits set if value < 0, else 0. sign_mask(a - b) is less_mask(a, b) where the difference fits, in fewer
// instructions.
constexpr std::int32_t sign_mask(std::int32_t value) {
  return value >> 31;
}

// With conditional moves the compiler implements a comparison without a jump, and masks are not needed.
#if defined(__x86_64__) || defined(__aarch64__)
inline constexpr bool kHasConditionalMoves = true;
#else
inline constexpr bool kHasConditionalMoves = false;
#endif

// a < b, without a branch.
template <class Integer>
constexpr bool is_less(Integer a, NonDeduced<Integer> b) {
  if constexpr (kHasConditionalMoves)
    return a < b;
  else
    return (less_mask<Integer>(a, b) & 1) != 0;
}

// The smaller and the larger of two numbers; `a` if they are equal or one is NaN.
template <class Number>
constexpr Number min(Number a, NonDeduced<Number> b) {
  if constexpr (!std::is_integral_v<Number>)
    return select(b < a, b, a);
  else if constexpr (kHasConditionalMoves)
    return b < a ? b : a;
  else
    return static_cast<Number>(a ^ ((a ^ b) & less_mask<Number>(b, a)));
}
template <class Number>
constexpr Number max(Number a, NonDeduced<Number> b) {
  if constexpr (!std::is_integral_v<Number>)
    return select(a < b, b, a);
  else if constexpr (kHasConditionalMoves)
    return a < b ? b : a;
  else
    return static_cast<Number>(a ^ ((a ^ b) & less_mask<Number>(a, b)));
}
// min() and max() of numbers whose difference fits into 31 bits, in fewer instructions where there are no
// conditional moves.
constexpr std::int32_t min_small(std::int32_t a, std::int32_t b) {
  return kHasConditionalMoves ? min(a, b) : b + ((a - b) & sign_mask(a - b));
}
constexpr std::int32_t max_small(std::int32_t a, std::int32_t b) {
  return kHasConditionalMoves ? max(a, b) : a + ((b - a) & sign_mask(a - b));
}
// Absolute value; the most negative integer stays as it is.
template <class Integer>
constexpr Integer abs(Integer value) {
  using Unsigned = std::make_unsigned_t<Integer>;
  const Integer sign = static_cast<Integer>(value >> (8 * sizeof(Integer) - 1));
  return static_cast<Integer>(static_cast<Unsigned>(value ^ sign) - static_cast<Unsigned>(sign));
}
// `value` limited to [low, high]; NaN gives `low`.
template <class Number>
constexpr Number clamp(Number value, NonDeduced<Number> low, NonDeduced<Number> high) {
  return min<Number>(high, max<Number>(low, value));
}

}  // namespace tumblesight::gnc
