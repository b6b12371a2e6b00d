#include "gnc/attitude/rotation.hpp"

#include <array>
#include <cmath>

namespace tumblesight::gnc {
namespace {

// Written out, so that the order of summation does not depend on Eigen's version.
float dot(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return (a.x() * b.x() + a.y() * b.y()) + a.z() * b.z();
}

Eigen::Vector3f scaled(const Eigen::Vector3f& v, float factor) {
  return {v.x() * factor, v.y() * factor, v.z() * factor};
}

Eigen::Vector3f divided(const Eigen::Vector3f& v, float divisor) {
  return {v.x() / divisor, v.y() / divisor, v.z() / divisor};
}

Eigen::Vector3f normalised(const Eigen::Vector3f& v) {
  constexpr float kSmallest = 1e-12F;
  const float square = dot(v, v);
  return divided(v, std::sqrt(square < kSmallest ? kSmallest : square));
}

using Candidate = std::array<float, 4>;  // w, x, y, z, not normalised

}  // namespace

RotationColumns orthonormalise(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Vector3f first = normalised(a);
  const Eigen::Vector3f along = scaled(first, dot(first, b));
  const Eigen::Vector3f across{b.x() - along.x(), b.y() - along.y(), b.z() - along.z()};
  return {first, normalised(across)};
}

Eigen::Matrix3f product(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  Eigen::Matrix3f result;
  for (int column = 0; column < 3; ++column) result.col(column) = product(a, Eigen::Vector3f(b.col(column)));
  return result;
}

Eigen::Matrix3f transpose_product(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  Eigen::Matrix3f result;
  for (int column = 0; column < 3; ++column) {
    result.col(column) = transpose_product(a, Eigen::Vector3f(b.col(column)));
  }
  return result;
}

Eigen::Vector3f product(const Eigen::Matrix3f& a, const Eigen::Vector3f& b) {
  return {dot(a.row(0), b), dot(a.row(1), b), dot(a.row(2), b)};
}

Eigen::Vector3f transpose_product(const Eigen::Matrix3f& a, const Eigen::Vector3f& b) {
  return {dot(a.col(0), b), dot(a.col(1), b), dot(a.col(2), b)};
}

float trace_of_transpose_product(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  return (dot(a.col(0), b.col(0)) + dot(a.col(1), b.col(1))) + dot(a.col(2), b.col(2));
}

Eigen::Matrix3f rotation_from_columns(const RotationColumns& columns) {
  const Eigen::Vector3f& u = columns.first;
  const Eigen::Vector3f& v = columns.second;
  Eigen::Matrix3f rotation;
  rotation.col(0) = u;
  rotation.col(1) = v;
  rotation(0, 2) = u.y() * v.z() - u.z() * v.y();
  rotation(1, 2) = u.z() * v.x() - u.x() * v.z();
  rotation(2, 2) = u.x() * v.y() - u.y() * v.x();
  return rotation;
}

Eigen::Quaternionf quaternion_from_rotation(const Eigen::Matrix3f& r) {
  const float wx = r(2, 1) - r(1, 2), wy = r(0, 2) - r(2, 0), wz = r(1, 0) - r(0, 1);
  const float xy = r(0, 1) + r(1, 0), xz = r(0, 2) + r(2, 0), yz = r(1, 2) + r(2, 1);
  // Row k is 4 q_k q, so its entry k is 4 q_k^2: the pivot.
  const std::array<Candidate, 4> candidates{{
      {1.0F + r(0, 0) + r(1, 1) + r(2, 2), wx, wy, wz},
      {wx, 1.0F + r(0, 0) - r(1, 1) - r(2, 2), xy, xz},
      {wy, xy, 1.0F - r(0, 0) + r(1, 1) - r(2, 2), yz},
      {wz, xz, yz, 1.0F - r(0, 0) - r(1, 1) + r(2, 2)},
  }};
  std::size_t best = 0;
  for (std::size_t k = 1; k < 4; ++k) best = candidates[k][k] > candidates[best][best] ? k : best;
  const Candidate& q = candidates[best];

  const float square = (q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]);
  // The pivots of any finite matrix add up to 4, so the largest is at least 1.
  const bool usable = square >= 0.5F && square <= 1e30F;
  const float length = std::sqrt(usable ? square : 1.0F);
  const float scale = q[0] < 0.0F ? -1.0F : 1.0F;
  return {usable ? scale * q[0] / length : 1.0F, usable ? scale * q[1] / length : 0.0F,
          usable ? scale * q[2] / length : 0.0F, usable ? scale * q[3] / length : 0.0F};
}

}  // namespace tumblesight::gnc
