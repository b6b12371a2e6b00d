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
  to = Fixed(is_finite(from) ? std::min(128.0F, std::max(-128.0F, from)) : 0.0F);
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
