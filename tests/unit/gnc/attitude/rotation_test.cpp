#include "gnc/attitude/rotation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "gnc/numerics/conversion.hpp"

namespace tumblesight::gnc {
namespace {

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

Eigen::Quaterniond quaternion_of(const Eigen::Matrix3d& rotation) {
  return to_double(quaternion_from_rotation(converted<Fixed>(Eigen::Matrix3f(rotation.cast<float>()))));
}

TEST(Orthonormalize, GivesARotationForAnyTwoIndependentVectors) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const float scale = std::pow(10.0F, static_cast<float>(i % 9) - 4.0F);
    const Eigen::Matrix3d r =
        rotation_from_columns<float>(orthonormalize<float>(random.vector(scale), random.vector()))
            .cast<double>();
    ASSERT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 5e-5) << i;
    ASSERT_NEAR(r.determinant(), 1.0, 5e-5) << i;
  }
}

TEST(Orthonormalize, KeepsTheFirstDirectionAndThePlane) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f a = random.vector();
    const Eigen::Vector3f b = random.vector();
    const RotationColumns<float> columns = orthonormalize<float>(a, b);
    EXPECT_LT((columns.first - a.normalized()).norm(), 1e-6F);
    EXPECT_NEAR(columns.second.dot(a.cross(b).normalized()), 0.0F, 1e-5F);
    EXPECT_GT(columns.second.dot(b), 0.0F);
  }
}

TEST(Orthonormalize, LeavesARotationUnchanged) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3f r = random.quaternion().toRotationMatrix().cast<float>();
    const Eigen::Matrix3f again = rotation_from_columns<float>(orthonormalize<float>(r.col(0), r.col(1)));
    EXPECT_LT((again - r).cwiseAbs().maxCoeff(), 1e-6F);
  }
}

TEST(Orthonormalize, IsFiniteForDegenerateVectors) {
  const Eigen::Vector3f zero = Eigen::Vector3f::Zero();
  const Eigen::Vector3f one{1.0F, 2.0F, 3.0F};
  for (const auto& pair :
       {std::pair{zero, zero}, {zero, one}, {one, zero}, {one, one}, {one, Eigen::Vector3f(-one)}}) {
    const RotationColumns<float> columns = orthonormalize<float>(pair.first, pair.second);
    EXPECT_TRUE(columns.first.allFinite() && columns.second.allFinite());
    EXPECT_NEAR(quaternion_of(rotation_from_columns<float>(columns).cast<double>()).norm(), 1.0, 1e-6);
  }
  EXPECT_EQ(orthonormalize<float>(zero, one).first, zero);
}

// Verifies TS-EST-100.
TEST(QuaternionFromRotation, AgreesWithTheRotationItCameFrom) {
  Random random;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Quaterniond truth = random.quaternion();
    const Eigen::Quaterniond q = quaternion_of(truth.toRotationMatrix());
    ASSERT_LT(q.angularDistance(truth), 1e-6) << i;
    ASSERT_NEAR(q.norm(), 1.0, 2e-9);
    ASSERT_GE(q.w(), 0.0);
  }
}

// Verifies TS-EST-100.
TEST(QuaternionFromRotation, IsAccurateNearHalfTurnsAboutEveryAxis) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    Eigen::Vector3d axis = random.vector().cast<double>().normalized();
    if (i % 4 != 3) axis = Eigen::Vector3d::Unit(i % 4);
    const double angle = M_PI - 1e-4 * (i % 7);
    const Eigen::Quaterniond truth(Eigen::AngleAxisd(angle, axis));
    const Eigen::Quaterniond q = quaternion_of(truth.toRotationMatrix());
    ASSERT_LT(q.angularDistance(truth), 1e-6);
    ASSERT_NEAR(q.norm(), 1.0, 2e-9);
    ASSERT_GE(q.w(), 0.0);
  }
}

TEST(QuaternionFromRotation, IsTheIdentityForTheIdentityAndTheZeroMatrix) {
  for (const Eigen::Matrix3f& r :
       {Eigen::Matrix3f(Eigen::Matrix3f::Identity()), Eigen::Matrix3f(Eigen::Matrix3f::Zero())}) {
    EXPECT_EQ(quaternion_from_rotation(converted<Fixed>(r)), kIdentityQ30);
  }
}

// Verifies TS-EST-100.
TEST(QuaternionFromRotation, IsUnitForAnyMatrixOfFixedNumbers) {
  std::mt19937 engine(3);
  std::uniform_int_distribution<std::int32_t> raw_values(-Fixed::kLargestRaw, Fixed::kLargestRaw);
  for (int i = 0; i < 2000; ++i) {
    Matrix3<Fixed> matrix;
    for (int k = 0; k < 9; ++k)
      matrix(k) = Fixed::from_raw(i % 3 == 0 ? Fixed::kLargestRaw : raw_values(engine));
    const QuaternionQ30 q = quaternion_from_rotation(matrix);
    ASSERT_NEAR(to_double(q).norm(), 1.0, 2e-9);
    ASSERT_GE(q[0], 0);
  }
}

}  // namespace
}  // namespace tumblesight::gnc
