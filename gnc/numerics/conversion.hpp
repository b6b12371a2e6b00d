// Between Fixed and whatever the network counts in.
#pragma once

#include <algorithm>

#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

inline void convert(Fixed from, Fixed& to) {
  to = from;
}
#if TUMBLESIGHT_FLOAT32
inline void convert(Fixed from, float& to) {
  to = static_cast<float>(from.raw()) * (1.0F / (1 << Fixed::kFractionBits));
}
// What is not finite counts as zero.
inline void convert(float from, Fixed& to) {
  const double scaled = double{select(is_finite(from), held_between(from, -128.0F, 128.0F), 0.0F)} * (1 << Fixed::kFractionBits);
  to = Fixed::from_raw(static_cast<std::int64_t>(scaled + std::copysign(0.5, scaled)));
}
#endif

template <class To, class From>
To converted(From from) {
  To to;
  convert(from, to);
  return to;
}
template <class To, class From>
Matrix3<To> converted(const Matrix3<From>& from) {
  Matrix3<To> to;
  for (int i = 0; i < 9; ++i) convert(from(i), to(i));
  return to;
}

}  // namespace tumblesight::gnc
