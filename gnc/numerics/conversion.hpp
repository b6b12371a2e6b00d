// Conversion between Fixed (Q7.24) and the number type of a network: Fixed itself or float.
#pragma once

#include <algorithm>

#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

// convert(from, to): float to Fixed rounds to the nearest, halves away from zero, and saturates. NaN and
// infinities become zero. Fixed to float rounds to 24 significant bits.
inline void convert(Fixed from, Fixed& to) {
  to = from;
}
#if TUMBLESIGHT_FLOAT32
inline void convert(Fixed from, float& to) {
  to = static_cast<float>(from.raw()) * (1.0F / (1 << Fixed::kFractionBits));
}
inline void convert(float from, Fixed& to) {
  constexpr float kLargest = 127.99999F;  // the largest float below 128
  const float finite = select(is_finite(from), from, 0.0F);
  const double scaled = static_cast<double>(clamp(finite, -kLargest, kLargest)) * (1 << Fixed::kFractionBits);
  const auto inside = static_cast<std::int32_t>(scaled + std::copysign(0.5, scaled));
  const std::int32_t not_above = select(finite > kLargest, Fixed::kLargestRaw, inside);
  to = Fixed::from_raw(select(finite < -kLargest, -Fixed::kLargestRaw, not_above));
}
#endif

// The same as a return value: converted<float>(fixed), converted<Fixed>(matrix).
template <class To, class From>
To converted(From from) {
  To to;
  convert(from, to);
  return to;
}
template <class To, class From>
Vector3<To> converted(const Vector3<From>& from) {
  return {converted<To>(from.x()), converted<To>(from.y()), converted<To>(from.z())};
}
template <class To, class From>
Matrix3<To> converted(const Matrix3<From>& from) {
  Matrix3<To> to;
  for (int i = 0; i < 9; ++i) convert(from(i), to(i));
  return to;
}

}  // namespace tumblesight::gnc
