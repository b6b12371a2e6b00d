// Choices without branches: the same instructions whatever is chosen, so that the time of a step does not depend on the
// data. Compilers are free to turn `condition ? yes : no` into a jump; they leave masks alone.
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

template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
constexpr Integer select(bool condition, Integer yes, Integer no) {
  return static_cast<Integer>(no ^ ((yes ^ no) & mask_of<Integer>(condition)));
}
inline float select(bool condition, float yes, float no) {
  std::uint32_t yes_bits, no_bits;
  std::memcpy(&yes_bits, &yes, sizeof yes);
  std::memcpy(&no_bits, &no, sizeof no);
  const std::uint32_t bits = select(condition, yes_bits, no_bits);
  std::memcpy(&yes, &bits, sizeof yes);
  return yes;
}

// Where there are conditional moves, compilers use them for the smaller and the larger of two integers.
#if defined(__x86_64__) || defined(__aarch64__) || defined(__arm__)
inline constexpr bool kMovesConditionally = true;
#else
inline constexpr bool kMovesConditionally = false;
#endif

template <class Number>
constexpr Number smaller_of(Number a, Number b) {
  if constexpr (kMovesConditionally && std::is_integral_v<Number>) return b < a ? b : a;
  return select(b < a, b, a);
}
template <class Number>
constexpr Number larger_of(Number a, Number b) {
  if constexpr (kMovesConditionally && std::is_integral_v<Number>) return a < b ? b : a;
  return select(a < b, b, a);
}
template <class Integer>
constexpr Integer magnitude_of(Integer value) {
  return select<Integer>(value < 0, static_cast<Integer>(-value), value);
}
// Held between `low` and `high`; NaN gives `low`.
template <class Number>
constexpr Number held_between(Number value, Number low, Number high) {
  return smaller_of(high, larger_of(low, value));
}

}  // namespace tumblesight::gnc
