// Rotations as the network states them (two columns) and as the outside wants them (quaternions).
#pragma once

#include <Eigen/Geometry>

namespace tumblesight::gnc {

// First two columns of a rotation matrix; the third is their cross product.
struct RotationColumns {
  Eigen::Vector3f first;
  Eigen::Vector3f second;
};

// Gram-Schmidt: x1 = a / |a|, x2 = (b - (x1 . b) x1) normalised. Squared lengths below 1e-12 count as 1e-12,
// so zero or parallel vectors give columns that are short, never a division by zero; non-finite input gives
// non-finite columns.
RotationColumns orthonormalise(const Eigen::Vector3f& a, const Eigen::Vector3f& b);

Eigen::Matrix3f rotation_from_columns(const RotationColumns& columns);

// a b, and a^T b. Written out, so that the order of summation does not depend on Eigen's version.
Eigen::Matrix3f product(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b);
Eigen::Matrix3f transpose_product(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b);
Eigen::Vector3f product(const Eigen::Matrix3f& a, const Eigen::Vector3f& b);
Eigen::Vector3f transpose_product(const Eigen::Matrix3f& a, const Eigen::Vector3f& b);
// trace(a^T b) = 1 + 2 cos(angle between them).
float trace_of_transpose_product(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b);

// Unit Hamilton quaternion with w >= 0 of a rotation matrix. Always unit: for a matrix that is no rotation it
// is the direction of the best conditioned formula, for the zero matrix and for non-finite ones the identity.
// Branch-free choice of the formula with the largest pivot (Shepperd 1978).
Eigen::Quaternionf quaternion_from_rotation(const Eigen::Matrix3f& rotation);

}  // namespace tumblesight::gnc
