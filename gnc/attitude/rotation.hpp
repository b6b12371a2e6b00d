// Rotation algebra: the network's representation (two matrix columns), rotation matrices and the quaternions
// of the interface. Real: float or Fixed (Q7.24).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "gnc/numerics/real.hpp"

namespace tumblesight::gnc {

// First two columns of a rotation matrix; the third is their cross product. A continuous representation (Zhou
// 2019).
template <class Real>
struct RotationColumns {
  Vector3<Real> first;
  Vector3<Real> second;
};

// Gram-Schmidt: first = a / |a|, second = b - (first . b) first, normalized. Zero or parallel vectors give
// columns shorter than 1, without a division by zero. Non-finite vectors give non-finite columns.
template <class Real>
RotationColumns<Real> orthonormalize(const Vector3<Real>& a, const Vector3<Real>& b) {
  const Vector3<Real> first = normalized(a);
  const Vector3<Real> along = scaled<Real>(first, dot(first, b));
  return {first, normalized(Vector3<Real>(b.x() - along.x(), b.y() - along.y(), b.z() - along.z()))};
}

// Products a b and a^T b. Written out so that the order of summation does not depend on the version of Eigen.
template <class Real>
Vector3<Real> product(const Matrix3<Real>& a, const Vector3<Real>& b) {
  return {dot(a.row(0), b), dot(a.row(1), b), dot(a.row(2), b)};
}
template <class Real>
Vector3<Real> transpose_product(const Matrix3<Real>& a, const Vector3<Real>& b) {
  return {dot(a.col(0), b), dot(a.col(1), b), dot(a.col(2), b)};
}
template <class Real>
Matrix3<Real> product(const Matrix3<Real>& a, const Matrix3<Real>& b) {
  Matrix3<Real> result;
  for (int column = 0; column < 3; ++column)
    result.col(column) = product<Real>(a, Vector3<Real>(b.col(column)));
  return result;
}
template <class Real>
Matrix3<Real> transpose_product(const Matrix3<Real>& a, const Matrix3<Real>& b) {
  Matrix3<Real> result;
  for (int column = 0; column < 3; ++column) {
    result.col(column) = transpose_product<Real>(a, Vector3<Real>(b.col(column)));
  }
  return result;
}

// trace(a^T b). For two rotations this is 1 + 2 cos(angle between them).
template <class Real>
Real trace_of_transpose_product(const Matrix3<Real>& a, const Matrix3<Real>& b) {
  return (dot(a.col(0), b.col(0)) + dot(a.col(1), b.col(1))) + dot(a.col(2), b.col(2));
}

// The matrix (first, second, first x second).
template <class Real>
Matrix3<Real> rotation_from_columns(const RotationColumns<Real>& columns) {
  const Vector3<Real>& u = columns.first;
  const Vector3<Real>& v = columns.second;
  Matrix3<Real> rotation;
  rotation.col(0) = u;
  rotation.col(1) = v;
  rotation(0, 2) = u.y() * v.z() - u.z() * v.y();
  rotation(1, 2) = u.z() * v.x() - u.x() * v.z();
  rotation(2, 2) = u.x() * v.y() - u.y() * v.x();
  return rotation;
}

// Unit quaternion, Hamilton convention, scalar first, each element in Q1.30.
using QuaternionQ30 = std::array<std::int32_t, 4>;
inline constexpr QuaternionQ30 kIdentityQ30{1 << 30, 0, 0, 0};

// Unit quaternion with w >= 0 of a rotation matrix (Shepperd 1978; the formula with the largest pivot is
// selected without a branch). Any matrix gives a unit quaternion, with a norm of 1 within 2e-9: the zero
// matrix the identity, another matrix that is not a rotation the normalized result of the best conditioned
// formula.
QuaternionQ30 quaternion_from_rotation(const Matrix3<Fixed>& rotation);

// For code that may use floating point.
inline Eigen::Quaterniond to_double(const QuaternionQ30& q) {
  constexpr double kUnit = 1.0 / (1 << 30);
  return {kUnit * q[0], kUnit * q[1], kUnit * q[2], kUnit * q[3]};
}

}  // namespace tumblesight::gnc
