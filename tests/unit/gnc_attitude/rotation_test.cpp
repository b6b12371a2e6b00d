#include "gnc/attitude/rotation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace tumblesight::gnc {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Random {
 public:
  float normal() { return static_cast<float>(distribution_(engine_)); }
  Eigen::Vector3f vector(float scale = 1.0F) {
    return {scale * normal(), scale * normal(), scale * normal()};
  }
  Eigen::Quaterniond quaternion() {
    return Eigen::Quaterniond(distribution_(engine_), distribution_(engine_), distribution_(engine_),
                              distribution_(engine_))
        .normalized();
  }

 private:
  std::mt19937 engine_{1};
  std::normal_distribution<double> distribution_;
};

double length(const Eigen::Quaternionf& q) {
  return q.cast<double>().coeffs().norm();
}

double angle_rad(const Eigen::Quaternionf& a, const Eigen::Quaterniond& b) {
  return a.cast<double>().angularDistance(b);
}

TEST(Orthonormalise, GivesARotationForAnyTwoIndependentVectors) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const float scale = std::pow(10.0F, static_cast<float>(i % 9) - 4.0F);
    const Eigen::Matrix3d r =
        rotation_from_columns(orthonormalise(random.vector(scale), random.vector())).cast<double>();
    ASSERT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 5e-5) << i;
    ASSERT_NEAR(r.determinant(), 1.0, 5e-5) << i;
  }
}

TEST(Orthonormalise, KeepsTheFirstDirectionAndThePlane) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f a = random.vector();
    const Eigen::Vector3f b = random.vector();
    const RotationColumns columns = orthonormalise(a, b);
    EXPECT_LT((columns.first - a.normalized()).norm(), 1e-6F);
    EXPECT_NEAR(columns.second.dot(a.cross(b).normalized()), 0.0F, 1e-5F);
    EXPECT_GT(columns.second.dot(b), 0.0F);
  }
}

TEST(Orthonormalise, LeavesARotationUnchanged) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3f r = random.quaternion().toRotationMatrix().cast<float>();
    const Eigen::Matrix3f again = rotation_from_columns(orthonormalise(r.col(0), r.col(1)));
    EXPECT_LT((again - r).cwiseAbs().maxCoeff(), 1e-6F);
  }
}

TEST(Orthonormalise, IsFiniteForDegenerateVectors) {
  const Eigen::Vector3f zero = Eigen::Vector3f::Zero();
  const Eigen::Vector3f one{1.0F, 2.0F, 3.0F};
  for (const auto& pair :
       {std::pair{zero, zero}, {zero, one}, {one, zero}, {one, one}, {one, Eigen::Vector3f(-one)}}) {
    const RotationColumns columns = orthonormalise(pair.first, pair.second);
    EXPECT_TRUE(columns.first.allFinite() && columns.second.allFinite());
    EXPECT_NEAR(length(quaternion_from_rotation(rotation_from_columns(columns))), 1.0, 1e-6);
  }
  EXPECT_EQ(orthonormalise(zero, one).first, zero);
}

TEST(QuaternionFromRotation, AgreesWithTheRotationItCameFrom) {
  Random random;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Quaterniond truth = random.quaternion();
    const Eigen::Quaternionf q = quaternion_from_rotation(truth.toRotationMatrix().cast<float>());
    ASSERT_LT(angle_rad(q, truth), 2e-6) << i;
    ASSERT_NEAR(length(q), 1.0, 2e-7);
    ASSERT_GE(q.w(), 0.0F);
  }
}

TEST(QuaternionFromRotation, HoldsNearHalfTurnsAboutEveryAxis) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    Eigen::Vector3d axis = random.vector().cast<double>().normalized();
    if (i % 4 != 3) axis = Eigen::Vector3d::Unit(i % 4);
    const double angle = M_PI - 1e-4 * (i % 7);
    const Eigen::Quaterniond truth(Eigen::AngleAxisd(angle, axis));
    const Eigen::Quaternionf q = quaternion_from_rotation(truth.toRotationMatrix().cast<float>());
    ASSERT_LT(angle_rad(q, truth), 2e-6);
    ASSERT_NEAR(length(q), 1.0, 2e-7);
    ASSERT_GE(q.w(), 0.0F);
  }
}

TEST(QuaternionFromRotation, IsTheIdentityForTheIdentityAndTheZeroMatrix) {
  for (const Eigen::Matrix3f& r :
       {Eigen::Matrix3f(Eigen::Matrix3f::Identity()), Eigen::Matrix3f(Eigen::Matrix3f::Zero())}) {
    const Eigen::Quaternionf q = quaternion_from_rotation(r);
    EXPECT_EQ(q.w(), 1.0F);
    EXPECT_EQ(q.vec().norm(), 0.0F);
  }
}

TEST(QuaternionFromRotation, IsTheIdentityForAnyNonFiniteEntry) {
  Random random;
  for (const float bad : {kInfinity, -kInfinity, kNan}) {
    for (int entry = 0; entry < 9; ++entry) {
      Eigen::Matrix3f r = random.quaternion().toRotationMatrix().cast<float>();
      r(entry / 3, entry % 3) = bad;
      const Eigen::Quaternionf q = quaternion_from_rotation(r);
      EXPECT_NEAR(length(q), 1.0, 2e-7) << bad << " at " << entry;
      EXPECT_GE(q.w(), 0.0F);
    }
  }
  const Eigen::Quaternionf q = quaternion_from_rotation(Eigen::Matrix3f::Constant(kNan));
  EXPECT_EQ(q.w(), 1.0F);
}

}  // namespace
}  // namespace tumblesight::gnc
