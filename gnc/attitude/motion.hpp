// Motion: attitude and rate of a rotating target, and where they are one frame later, by which law. Time is
// counted in frames, so that a rate is the turn of one frame period, in radians. Real: float or Fixed.
#pragma once

#include <array>

#include "gnc/attitude/rotation.hpp"
#include "gnc/numerics/conversion.hpp"

namespace tumblesight::gnc {

template <class Real>
struct Motion {
  Matrix3<Real> r_lrf_trf = Matrix3<Real>::Identity();
  Vector3<Real> rate_lrf = Vector3<Real>::Zero();  // radians a frame
};

// Inertia of the target in the TRF, scaled to a trace of 3, since only ratios matter; and its inverse.
template <class Real>
struct Inertia {
  Matrix3<Real> tensor_trf = Matrix3<Real>::Identity();
  Matrix3<Real> inverse_trf = Matrix3<Real>::Identity();
};
// No moment of inertia may be smaller than this beside the mean of all three.
inline constexpr double kSmallestMoment = 0.01;
// False unless the tensor is finite, symmetric and positive definite, with moments not below kSmallestMoment;
// `inertia` is untouched then.
template <class Real>
[[nodiscard]] bool make_inertia(const Matrix3<Real>& tensor_trf, Inertia<Real>& inertia);

template <class To>
Inertia<To> converted(const Inertia<Fixed>& inertia) {
  return {converted<To>(inertia.tensor_trf), converted<To>(inertia.inverse_trf)};
}

// Longer rates are shortened to this before they are used: twice what the network is trained for.
inline constexpr float kLargestRate = 1.9F;

// exp([turn]x); for turns up to kLargestRate within 1e-6.
template <class Real>
Matrix3<Real> rotation_by(const Vector3<Real>& turn);
// Its inverse for turns below 60 degrees, within 1e-5; zero for longer ones.
template <class Real>
Vector3<Real> small_turn_of(const Matrix3<Real>& rotation);

// One frame later, free of torque: angular momentum is constant in the LRF and the rate follows from the
// attitude (paper, tumbling test). Of a sphere's inertia the rate is constant in the LRF (paper, sampling of
// the sequences). Midpoint method in four steps; at 54 degrees a frame within about 0.5 degrees.
template <class Real>
Motion<Real> tumble(const Motion<Real>& motion, const Inertia<Real>& inertia);

// The laws of motion that a target is thought to follow: tumbling with
//   0     a sphere's inertia: it spins at a rate constant in the LRF
//   1     its own inertia
//   2..4  its own with the moment about the TRF's x, y or z axis halved, for an inertia known to a factor of
//         two only: fuel is spent, an appendage broke off or never unfolded
inline constexpr int kLaws = 5;
inline constexpr int kSpinLaw = 0;
inline constexpr int kTumbleLaw = 1;
template <class Real>
using MotionLaws = std::array<Inertia<Real>, kLaws>;
template <class Real>
MotionLaws<Real> motion_laws(const Inertia<Real>& inertia);

}  // namespace tumblesight::gnc
