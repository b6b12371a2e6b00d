// Verifies TS-FDIR-070.
#include "fsw/app/attitude_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace tumblesight::fsw {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::uint32_t kLimit_urad = 500'000;

gnc::QuaternionQ30 q30(Eigen::Quaterniond q) {
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const auto part = [](double x) { return static_cast<std::int32_t>(std::lround(std::ldexp(x, 30))); };
  return {part(q.w()), part(q.x()), part(q.y()), part(q.z())};
}
Eigen::Quaterniond turned(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}
Eigen::Quaterniond random_attitude(std::mt19937& engine) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine)).normalized();
}

TEST(AttitudeCheck, CosineOfHalfAnAngleMatchesTheLibrary) {
  for (std::uint32_t angle_urad = 0; angle_urad <= 3'141'593; angle_urad += 31'415) {
    EXPECT_NEAR(std::ldexp(cos_half_of(angle_urad), -30), std::cos(0.5e-6 * angle_urad), 3e-5) << angle_urad;
  }
}

TEST(AttitudeCheck, CosineBetweenAttitudesMatchesEigen) {
  std::mt19937 engine(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond a = random_attitude(engine), b = random_attitude(engine);
    EXPECT_NEAR(std::ldexp(cos_half_angle(q30(a), q30(b)), -30), std::abs(a.dot(b)), 1e-8);
  }
}

TEST(AttitudeCheck, ExtrapolationContinuesTheRotation) {
  std::mt19937 engine(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond first = random_attitude(engine), turn = turned(0.9, Eigen::Vector3d(1, -2, i));
    const gnc::QuaternionQ30 third = propagated(q30(first), q30(turn * first));
    EXPECT_NEAR(std::abs(gnc::to_double(third).dot(turn * turn * first)), 1.0, 1e-8);
  }
}

TEST(AttitudeCheck, AConstantRateNeverJumps) {
  AttitudeCheck check;
  Eigen::Quaterniond q = turned(1.0, {1, 1, 0});
  for (int i = 0; i < 50; ++i, q = turned(20.0 * 2.7 * kPi / 180.0, {0.3, 1, -2}) * q) {
    EXPECT_FALSE(check.jumps(q30(q), kLimit_urad)) << i;
  }
}

TEST(AttitudeCheck, OnlyJumpsBeyondTheLimitAreDetected) {
  for (const double factor : {0.95, 1.05}) {
    AttitudeCheck check;
    const Eigen::Quaterniond q = turned(1.0, {1, 1, 0});
    check.jumps(q30(q), kLimit_urad);
    check.jumps(q30(q), kLimit_urad);
    EXPECT_EQ(check.jumps(q30(turned(factor * 1e-6 * kLimit_urad, {0, 1, 0}) * q), kLimit_urad),
              factor > 1.0);
  }
}

TEST(AttitudeCheck, NoJumpIsDetectedWithFewerThanTwoAttitudesOrAfterForgetting) {
  AttitudeCheck check;
  std::mt19937 engine(3);
  EXPECT_FALSE(check.jumps(q30(turned(0, {1, 0, 0})), kLimit_urad));
  EXPECT_FALSE(check.jumps(q30(turned(3, {1, 0, 0})), kLimit_urad));
  check.forget();
  EXPECT_FALSE(check.jumps(q30(turned(1, {0, 1, 0})), kLimit_urad));
  EXPECT_FALSE(check.jumps(q30(turned(3, {0, 0, 1})), kLimit_urad));
  EXPECT_TRUE(check.jumps(q30(turned(3, {0, 1, 0})), kLimit_urad));
}

TEST(AttitudeCheck, LimitOfAHalfTurnDetectsNoJump) {
  AttitudeCheck check;
  std::mt19937 engine(4);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(check.jumps(q30(random_attitude(engine)), 3'141'593));
}

TEST(AttitudeCheck, EqualBitsAreARepetition) {
  AttitudeCheck check;
  EXPECT_FALSE(check.repeats(gnc::kIdentityQ30)) << "nothing precedes the first one";
  EXPECT_TRUE(check.repeats(gnc::kIdentityQ30));
  for (std::size_t i = 0; i < 4; ++i) {
    gnc::QuaternionQ30 other = gnc::kIdentityQ30;
    --other[i];
    EXPECT_FALSE(check.repeats(other)) << "differs in one bit";
    EXPECT_TRUE(check.repeats(other));
  }
  check.forget();
  EXPECT_FALSE(check.repeats(gnc::kIdentityQ30));
}

TEST(IsUnit, AcceptsUnitQuaternionsOnly) {
  EXPECT_TRUE(is_unit(gnc::kIdentityQ30));
  EXPECT_TRUE(is_unit(q30(turned(1.0, {1, 2, 3}))));
  EXPECT_FALSE(is_unit({0, 0, 0, 0}));
  EXPECT_FALSE(is_unit({(1 << 30) + 2000, 0, 0, 0}));
  EXPECT_FALSE(is_unit({(1 << 30) - 2000, 0, 0, 0}));
  EXPECT_FALSE(is_unit({INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN}));
}

}  // namespace
}  // namespace tumblesight::fsw
