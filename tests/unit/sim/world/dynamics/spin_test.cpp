// Verifies TS-SIL-080.
#include "sim/world/dynamics/spin.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace tumblesight::sim
