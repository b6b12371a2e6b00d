#include "gnc/attitude/quaternion.hpp"

namespace tumblesight::gnc {
namespace {

constexpr int kBits = 30;
constexpr std::int64_t kOne = std::int64_t{1} << kBits;

std::int64_t product(std::int64_t a, std::int64_t b) {
  return (a * b + kOne / 2) >> kBits;
}

std::int32_t bounded(std::int64_t part) {
  return static_cast<std::int32_t>(clamp<std::int64_t>(part, -INT32_MAX, INT32_MAX));
}

}  // namespace

bool is_unit(const QuaternionQ30& q) {
  std::int64_t square = 0;  // Q28
  for (const std::int32_t part : q) square += (static_cast<std::int64_t>(part) * part) >> 32;
  constexpr std::int64_t kOne28 = std::int64_t{1} << 28;
  constexpr std::int64_t kTolerance = kOne28 / 500'000;
  return square > kOne28 - kTolerance && square < kOne28 + kTolerance;
}

QuaternionQ30 conjugate(const QuaternionQ30& q) {
  return {q[0], bounded(-std::int64_t{q[1]}), bounded(-std::int64_t{q[2]}), bounded(-std::int64_t{q[3]})};
}

// 64 bits, because a sum of four products can reach 4.
QuaternionQ30 product(const QuaternionQ30& a, const QuaternionQ30& b) {
  return {bounded(product(a[0], b[0]) - product(a[1], b[1]) - product(a[2], b[2]) - product(a[3], b[3])),
          bounded(product(a[0], b[1]) + product(a[1], b[0]) + product(a[2], b[3]) - product(a[3], b[2])),
          bounded(product(a[0], b[2]) - product(a[1], b[3]) + product(a[2], b[0]) + product(a[3], b[1])),
          bounded(product(a[0], b[3]) + product(a[1], b[2]) - product(a[2], b[1]) + product(a[3], b[0]))};
}

Matrix3<Fixed> rotation_from_quaternion(const QuaternionQ30& q) {
  const auto twice = [&q](std::size_t i, std::size_t k) { return 2 * product(q[i], q[k]); };
  const auto element = [](std::int64_t q30) {
    constexpr int kShift = kBits - Fixed::kFractionBits;
    return Fixed::from_raw((q30 + (1 << (kShift - 1))) >> kShift);
  };
  const std::int64_t xx = twice(1, 1), yy = twice(2, 2), zz = twice(3, 3);
  const std::int64_t xy = twice(1, 2), xz = twice(1, 3), yz = twice(2, 3);
  const std::int64_t wx = twice(0, 1), wy = twice(0, 2), wz = twice(0, 3);
  Matrix3<Fixed> r;
  r << element(kOne - yy - zz), element(xy - wz), element(xz + wy),  //
      element(xy + wz), element(kOne - xx - zz), element(yz - wx),   //
      element(xz - wy), element(yz + wx), element(kOne - xx - yy);
  return r;
}

std::int32_t cos_half_angle(const QuaternionQ30& a, const QuaternionQ30& b) {
  std::int64_t dot = 0;
  for (std::size_t i = 0; i < 4; ++i) dot += product(a[i], b[i]);
  if (dot < 0) dot = -dot;
  return static_cast<std::int32_t>(dot < kOne ? dot : kOne);
}

// Taylor series up to the eighth power; half of the angle is at most pi / 2.
std::int32_t cos_half_of(std::uint32_t angle_urad) {
  const std::int64_t half = static_cast<std::int64_t>(angle_urad) * kOne / 2'000'000;
  const std::int64_t square = product(half, half);
  std::int64_t sum = kOne;
  for (const std::int64_t divisor : {56, 30, 12, 2}) sum = kOne - product(square, sum) / divisor;
  return static_cast<std::int32_t>(sum > 0 ? sum : 0);
}

}  // namespace tumblesight::gnc
