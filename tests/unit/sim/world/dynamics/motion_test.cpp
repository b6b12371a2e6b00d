// Verifies TS-SIL-080. Spin turns at a constant rate. Without torque a rigid body keeps its angular momentum
// and its kinetic energy, and agrees with the closed-form solutions where they exist.
#include "sim/world/dynamics/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace tumblesight::sim {

namespace {

constexpr double kDegree = 0.017453292519943295;

TEST(Spin, NinetyDegreesAboutZTakesXToY) {
  const Eigen::Quaterniond q =
      spin(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.0, 0.0, 30.0 * kDegree), 3.0);
  EXPECT_LT((q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(Spin, TurnsAboutAnAxisOfTheLidarFrameAtAnyAttitude) {
  const Eigen::Quaterniond q0 = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  const Eigen::Vector3d rate(0.1, -0.2, 0.15);
  const Eigen::Vector3d axis_trf = q0.conjugate() * rate.normalized();
  const Eigen::Quaterniond q = spin(q0, rate, 7.3);
  EXPECT_LT((q * axis_trf - rate.normalized()).norm(), 1e-12);
  EXPECT_NEAR(q.angularDistance(q0), std::remainder(rate.norm() * 7.3, 2.0 * M_PI), 1e-12);
}

TEST(Spin, AtRestTheAttitudeDoesNotChange) {
  const Eigen::Quaterniond q0 = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
  EXPECT_EQ(spin(q0, Eigen::Vector3d::Zero(), 100.0).coeffs(), q0.coeffs());
}

constexpr double kFast_rad_s = 20.0 * kDegree;

Eigen::Matrix3d near_inertia() {  // paper, spacecraft table
  Eigen::Matrix3d inertia;
  inertia << 372.38, -2.86, -2.95, -2.86, 372.45, -4.42, -2.95, -4.42, 316.17;
  return inertia;
}

TumbleState some_state() {
  return {Eigen::Quaterniond(0.8, -0.3, 0.4, 0.2).normalized(),
          kFast_rad_s * Eigen::Vector3d(0.6, -0.5, 0.7).normalized()};
}

TEST(Tumble, KeepsMomentumAndEnergyOver200Seconds) {
  // Includes the intermediate axis, near which the motion is unstable.
  Eigen::Matrix3d uneven = Eigen::Vector3d(3266.61, 4772.03, 2897.59).asDiagonal();
  for (const Eigen::Matrix3d& inertia : {near_inertia(), uneven}) {
    const Tumble tumble(inertia);
    TumbleState state = some_state();
    if (inertia == uneven) state.rate_trf_rad_s = kFast_rad_s * Eigen::Vector3d(1.0, 0.01, 0.01).normalized();
    const Eigen::Vector3d momentum = state.q_lrf_trf * (inertia * state.rate_trf_rad_s);
    const double energy = state.rate_trf_rad_s.dot(inertia * state.rate_trf_rad_s);
    const Eigen::Vector3d first_rate = state.rate_trf_rad_s;
    double wander = 0.0;
    for (int second = 0; second < 200; ++second) {
      state = tumble.after(state, 1.0);
      const Eigen::Vector3d momentum_now = state.q_lrf_trf * (inertia * state.rate_trf_rad_s);
      ASSERT_LT((momentum_now - momentum).norm(), 1e-6 * momentum.norm()) << second;
      ASSERT_NEAR(state.rate_trf_rad_s.dot(inertia * state.rate_trf_rad_s), energy, 1e-6 * energy) << second;
      ASSERT_NEAR(state.q_lrf_trf.norm(), 1.0, 1e-12);
      wander = std::max(wander, (state.rate_trf_rad_s - first_rate).norm());
    }
    EXPECT_GT(wander, 1.0 * kDegree) << "the test needs a body that tumbles";
  }
}

TEST(Tumble, AnAxisymmetricBodyPrecessesAsTheClosedForm) {
  // w = H / A - l e3 with l = (C - A) w3 / A: the body turns about H, fixed in the LRF, at |H| / A, and about
  // its own axis at -l.
  for (const double axial : {1.6, 0.5}) {
    const Eigen::Matrix3d inertia = Eigen::Vector3d(1.0, 1.0, axial).asDiagonal();
    const TumbleState start = some_state();
    const Eigen::Vector3d momentum = start.q_lrf_trf * (inertia * start.rate_trf_rad_s);
    const double own = -(axial - 1.0) * start.rate_trf_rad_s.z();
    for (const double time_s : {0.02, 2.7, 24.3}) {
      const TumbleState state = Tumble(inertia).after(start, time_s);
      const Eigen::Quaterniond about_own_axis(Eigen::AngleAxisd(own * time_s, Eigen::Vector3d::UnitZ()));
      const Eigen::Quaterniond expected = spin(start.q_lrf_trf, momentum, time_s) * about_own_axis;
      EXPECT_LT(state.q_lrf_trf.angularDistance(expected), 1e-6) << axial << ' ' << time_s;
      const Eigen::Vector3d rate = about_own_axis.conjugate() * start.rate_trf_rad_s;
      EXPECT_LT((state.rate_trf_rad_s - rate).norm(), 1e-7) << axial << ' ' << time_s;
    }
  }
}

TEST(Tumble, ABallSpinsAtAConstantRate) {
  const TumbleState start = some_state();
  const TumbleState state = Tumble(5.0 * Eigen::Matrix3d::Identity()).after(start, 24.3);
  const Eigen::Quaterniond expected = spin(start.q_lrf_trf, start.q_lrf_trf * start.rate_trf_rad_s, 24.3);
  EXPECT_LT(state.q_lrf_trf.angularDistance(expected), 1e-7);
  EXPECT_LT((state.rate_trf_rad_s - start.rate_trf_rad_s).norm(), 1e-12);
}

TEST(Tumble, ManySmallStepsEqualOneLargeStep) {
  const Tumble tumble(near_inertia());
  TumbleState small = some_state();
  for (int i = 0; i < 27; ++i) small = tumble.after(small, 0.1);
  const TumbleState large = tumble.after(some_state(), 2.7);
  EXPECT_LT(small.q_lrf_trf.angularDistance(large.q_lrf_trf), 1e-7);
  EXPECT_LT((small.rate_trf_rad_s - large.rate_trf_rad_s).norm(), 1e-9);
}

TEST(Tumble, DoesNotMoveInZeroTimeOrAtRest) {
  const Tumble tumble(near_inertia());
  const TumbleState start = some_state();
  EXPECT_LT(tumble.after(start, 0.0).q_lrf_trf.angularDistance(start.q_lrf_trf), 1e-7);
  const TumbleState rest = tumble.after({start.q_lrf_trf, Eigen::Vector3d::Zero()}, 100.0);
  EXPECT_LT(rest.q_lrf_trf.angularDistance(start.q_lrf_trf), 1e-7);
  EXPECT_EQ(rest.rate_trf_rad_s, Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

TEST(Tumble, AnImpossibleInertiaIsRefused) {
  Eigen::Matrix3d asymmetric = near_inertia();
  asymmetric(0, 1) += 1.0;
  Eigen::Matrix3d indefinite = near_inertia();
  indefinite(2, 2) = -1.0;
  Eigen::Matrix3d not_finite = near_inertia();
  not_finite(1, 1) = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Matrix3d& bad :
       {asymmetric, indefinite, not_finite, Eigen::Matrix3d(Eigen::Matrix3d::Zero())}) {
    EXPECT_THROW(Tumble{bad}, std::invalid_argument) << bad;
  }
  EXPECT_NO_THROW(Tumble{near_inertia()});
}

}  // namespace

}  // namespace tumblesight::sim
