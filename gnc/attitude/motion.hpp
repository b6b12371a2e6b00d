// Torque-free rotation of the target: attitude and angular rate, and their prediction over any time.
//
// A rate is the rotation vector of one nominal frame period, in radians per period, whatever the time between
// two frames is.
// Real: float or Fixed (Q7.24).
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/rotation.hpp"
#include "gnc/numerics/conversion.hpp"

namespace tumblesight::gnc {

inline constexpr std::int64_t kNominalPeriod_ns = 2'700'000'000;  // of the training data
// Longer times are limited to this one.
inline constexpr int kMaxPeriods = 16;
inline constexpr std::int64_t kLongestPropagation_ns = kMaxPeriods * kNominalPeriod_ns;

template <class Real>
struct Motion {
  Matrix3<Real> r_lrf_trf = Matrix3<Real>::Identity();  // v_lrf = r_lrf_trf v_trf
  Vector3<Real> rate_lrf = Vector3<Real>::Zero();       // [rad per nominal period]
};

// The time `elapsed_ns` in nominal periods, limited to 0 ... kMaxPeriods; exactly 1 for one period.
Fixed in_periods(std::int64_t elapsed_ns);

// Inertia tensor of the target in the TRF and its inverse. Scaled to a trace of 3: only the ratios matter for
// torque-free rotation.
template <class Real>
struct Inertia {
  Matrix3<Real> tensor_trf = Matrix3<Real>::Identity();
  Matrix3<Real> inverse_trf = Matrix3<Real>::Identity();
};
// Smallest principal moment of inertia that is accepted, as a fraction of the mean of all three.
inline constexpr double kSmallestMoment = 0.01;
// Scales `tensor_trf` (any unit) and inverts it. Returns false and leaves `inertia` unchanged unless the
// tensor is finite, symmetric and positive definite and no principal moment is below kSmallestMoment.
template <class Real>
[[nodiscard]] bool make_inertia(const Matrix3<Real>& tensor_trf, Inertia<Real>& inertia);

template <class To>
Inertia<To> converted(const Inertia<Fixed>& inertia) {
  return {converted<To>(inertia.tensor_trf), converted<To>(inertia.inverse_trf)};
}

// Rates are limited to this length before use [rad per nominal period]: twice the largest rate of the
// training data.
inline constexpr float kLargestRate = 1.9F;

// Rotation matrix of a rotation vector [rad]: exp([turn]x), by Taylor series. Vectors longer than
// kLargestRate are limited to it. Error of an element at most 1e-6.
template <class Real>
Matrix3<Real> rotation_from_vector(const Vector3<Real>& turn);
// Rotation vector [rad] of a rotation matrix, the inverse of rotation_from_vector(), for angles below 60
// degrees; error at most 1e-5. Zero for larger angles.
template <class Real>
Vector3<Real> small_rotation_vector(const Matrix3<Real>& rotation);
// The same for angles whose versine, 1 - cos(angle), is below `largest_versine`, at most that of 150 degrees;
// error at most 1e-3 from 60 degrees on. Zero for larger angles.
template <class Real>
Vector3<Real> rotation_vector(const Matrix3<Real>& rotation, Real largest_versine);
inline constexpr double kVersineOf60Degrees = 0.5;
inline constexpr double kVersineOf150Degrees = 1.8660254037844386;

// Motion `elapsed_ns` later (limited to 0 ... kLongestPropagation_ns), without torque: the angular momentum
// is constant in an LRF that does not turn, and the rate follows from the attitude (paper, tumbling test).
// With the inertia of a sphere the rate is constant in the LRF (paper, sampling of the sequences). Midpoint
// method with four steps per nominal period or part of it; error about 0.5 degrees per period at 54 degrees
// per period. The instruction count depends on the time only.
template <class Real>
Motion<Real> propagate(const Motion<Real>& motion, const Inertia<Real>& inertia,
                       std::int64_t elapsed_ns = kNominalPeriod_ns);
// The same motion in an LRF that has turned: `r_now_last` takes the LRF before to the LRF after.
template <class Real>
Motion<Real> turned(const Motion<Real>& motion, const Matrix3<Real>& r_now_last);

// A rate in microradians per second, rounded to the nearest.
std::array<std::int32_t, 3> rate_urad_s(const Vector3<Fixed>& rate);

// The motion models that the track follows in parallel. Each is torque-free rotation with its own inertia:
//   0     that of a sphere: spin at a rate constant in the LRF
//   1     that of the target
//   2..4  that of the target with the moment about the TRF's x, y or z axis halved. They cover
//         an inertia known only to a factor of two: fuel was spent, or an appendage broke off
//         or did not deploy.
inline constexpr int kMotionModels = 5;
inline constexpr int kSpinModel = 0;
inline constexpr int kTumbleModel = 1;
template <class Real>
using MotionModels = std::array<Inertia<Real>, kMotionModels>;
// The inertias of all motion models for a target with `inertia`. A motion model whose halved moment would
// fall below kSmallestMoment gets `inertia` itself.
template <class Real>
MotionModels<Real> motion_models(const Inertia<Real>& inertia);

}  // namespace tumblesight::gnc
