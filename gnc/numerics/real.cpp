#include "gnc/numerics/real.hpp"

#include "gnc/numerics/division.hpp"

namespace tumblesight::gnc {

Vector3<Fixed> normalized(const Vector3<Fixed>& v) {
  std::int64_t raw[3];
  std::int64_t bits = 0;
  for (int i = 0; i < 3; ++i) {
    raw[i] = v[i].raw();
    bits |= abs(raw[i]);
  }
  const std::int64_t scale = std::int64_t{1} << (30 - highest_bit(static_cast<std::uint64_t>(bits)));
  std::uint64_t square = 0;
  for (std::int64_t& component : raw) {
    component *= scale;  // now |component| < 2^31
    square += static_cast<std::uint64_t>(component * component);
  }
  const std::int64_t length = integer_sqrt(square);  // at least 2^30, except for the zero vector
  const std::int64_t divisor = max<std::int64_t>(length, 1);
  Vector3<Fixed> unit;
  for (int i = 0; i < 3; ++i) {
    // To the nearest, halves away from zero.
    const std::int64_t magnitude = abs(raw[i]);
    const std::int64_t rounded =
        (divide(magnitude * (std::int64_t{2} << Fixed::kFractionBits), divisor) + 1) >> 1;
    unit[i] = Fixed::from_raw(select(is_less<std::int64_t>(raw[i], 0), -rounded, rounded));
  }
  return unit;
}

}  // namespace tumblesight::gnc
