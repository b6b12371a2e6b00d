#include "gnc/attitude/quaternion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace tumblesight::gnc {
namespace {

QuaternionQ30 q30(Eigen::Quaterniond q) {
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

TEST(Quaternion, CosineOfHalfAnAngleMatchesTheLibrary) {
  for (std::uint32_t angle_urad = 0; angle_urad <= 3'141'593; angle_urad += 31'415) {
    EXPECT_NEAR(std::ldexp(cos_half_of(angle_urad), -30), std::cos(0.5e-6 * angle_urad), 3e-5) << angle_urad;
  }
}

TEST(Quaternion, CosineBetweenAttitudesMatchesEigen) {
  std::mt19937 engine(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond a = random_attitude(engine), b = random_attitude(engine);
    EXPECT_NEAR(std::ldexp(cos_half_angle(q30(a), q30(b)), -30), std::abs(a.dot(b)), 1e-8);
  }
}

TEST(Quaternion, ProductAndInverseMatchEigen) {
  std::mt19937 engine(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond a = random_attitude(engine), b = random_attitude(engine);
    EXPECT_NEAR(std::abs(to_double(product(q30(a), q30(b))).dot(a * b)), 1.0, 1e-8);
    EXPECT_NEAR(std::abs(to_double(conjugate(q30(a))).dot(a.conjugate())), 1.0, 1e-8);
  }
}

TEST(Quaternion, RotationMatchesEigenAndTheIdentityIsExact) {
  std::mt19937 engine(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond q = random_attitude(engine);
    const Matrix3<Fixed> r = rotation_from_quaternion(q30(q));
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(std::ldexp(r(k).raw(), -24), q.toRotationMatrix()(k), 1.5e-7);
  }
  const Matrix3<Fixed> r = rotation_from_quaternion(kIdentityQ30);
  const Matrix3<Fixed> identity = Matrix3<Fixed>::Identity();
  for (int k = 0; k < 9; ++k) EXPECT_EQ(r(k).raw(), identity(k).raw());
}

TEST(IsUnit, AcceptsUnitQuaternionsOnly) {
  EXPECT_TRUE(is_unit(kIdentityQ30));
  EXPECT_TRUE(is_unit(q30(turned(1.0, {1, 2, 3}))));
  EXPECT_FALSE(is_unit({0, 0, 0, 0}));
  EXPECT_FALSE(is_unit({(1 << 30) + 2000, 0, 0, 0}));
  EXPECT_FALSE(is_unit({(1 << 30) - 2000, 0, 0, 0}));
  EXPECT_FALSE(is_unit({INT32_MIN, INT32_MIN, INT32_MIN, INT32_MIN}));
}

}  // namespace
}  // namespace tumblesight::gnc
