#include "gnc/attitude/rotation.hpp"

#include "gnc/numerics/division.hpp"

namespace tumblesight::gnc {
namespace {

// Quaternion in Q24 that is not normalized.
using Candidate = std::array<std::int64_t, 4>;

// Unit quaternion with w >= 0, each element rounded to the nearest, halves away from zero. Requires |q| <=
// 2^41.
QuaternionQ30 normalized(const Candidate& q) {
  std::int64_t bits = 0;
  for (const std::int64_t part : q) bits |= abs(part);
  const int left = 30 - highest_bit(static_cast<std::uint64_t>(bits));
  const std::int32_t up = std::int32_t{1} << max(left, 0);
  const std::int32_t down = std::int32_t{1} << max(-left, 0);
  std::array<std::int64_t, 4> scaled;
  std::uint64_t square = 0;
  for (int i = 0; i < 4; ++i) {
    scaled[i] = divide(q[i] * up, down);
    square += static_cast<std::uint64_t>(scaled[i] * scaled[i]);
  }
  const std::int64_t length = integer_sqrt(square);
  const bool turned = is_less<std::int64_t>(q[0], 0);
  QuaternionQ30 unit;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t magnitude = abs(scaled[i]);
    const std::int64_t rounded =
        (divide(magnitude * (std::int64_t{1} << 31), max<std::int64_t>(length, 1)) + 1) >> 1;
    unit[i] =
        static_cast<std::int32_t>(select(is_less<std::int64_t>(scaled[i], 0) != turned, -rounded, rounded));
  }
  return unit;
}

}  // namespace

QuaternionQ30 quaternion_from_rotation(const Matrix3<Fixed>& rotation) {
  const auto r = [&rotation](int row, int column) { return std::int64_t{rotation(row, column).raw()}; };
  constexpr std::int64_t kOne = std::int64_t{1} << Fixed::kFractionBits;
  const std::int64_t wx = r(2, 1) - r(1, 2), wy = r(0, 2) - r(2, 0), wz = r(1, 0) - r(0, 1);
  const std::int64_t xy = r(0, 1) + r(1, 0), xz = r(0, 2) + r(2, 0), yz = r(1, 2) + r(2, 1);
  // Row k is 4 q_k q; its element k, the pivot, is 4 q_k^2. The pivots of any matrix add up to 4, so the
  // largest is at least 1.
  const std::array<Candidate, 4> candidates{{
      {kOne + r(0, 0) + r(1, 1) + r(2, 2), wx, wy, wz},
      {wx, kOne + r(0, 0) - r(1, 1) - r(2, 2), xy, xz},
      {wy, xy, kOne - r(0, 0) + r(1, 1) - r(2, 2), yz},
      {wz, xz, yz, kOne - r(0, 0) - r(1, 1) + r(2, 2)},
  }};
  std::size_t best = 0;
  for (std::size_t k = 1; k < 4; ++k)
    best = select(is_less(candidates[best][best], candidates[k][k]), k, best);
  return normalized(candidates[best]);
}

}  // namespace tumblesight::gnc
