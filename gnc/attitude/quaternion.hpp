// Algebra of the quaternions of the interface: Hamilton, scalar first, unit norm, Q1.30. Integers only, for
// both numerics of the network.
#pragma once

#include <cstdint>

#include "gnc/attitude/rotation.hpp"

namespace tumblesight::gnc {

// Whether the squared norm is 1 within 2e-6.
bool is_unit(const QuaternionQ30& q);

// The inverse rotation.
QuaternionQ30 conjugate(const QuaternionQ30& q);
// Hamilton product of two unit quaternions, error at most 2^-29 per element.
QuaternionQ30 product(const QuaternionQ30& a, const QuaternionQ30& b);
// The matrix of the same rotation, error at most 2^-23 per element. The identity gives exactly the identity.
Matrix3<Fixed> rotation_from_quaternion(const QuaternionQ30& q);

// Cosine of half the angle between two unit quaternions, |a . b|, in Q30.
std::int32_t cos_half_angle(const QuaternionQ30& a, const QuaternionQ30& b);
// Cosine of half of an angle in 0 ... pi, in Q30, with an error below 2.5e-5, the largest at pi.
std::int32_t cos_half_of(std::uint32_t angle_urad);

}  // namespace tumblesight::gnc
