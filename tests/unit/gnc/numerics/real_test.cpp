// Verifies TS-NUM-090.
#include "gnc/numerics/real.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

#include "gnc/attitude/motion.hpp"
#include "gnc/numerics/conversion.hpp"

namespace tumblesight::gnc {
namespace {

Eigen::Vector3f random_vector(std::mt19937& engine, float scale) {
  std::normal_distribution<float> normal(0.0F, scale);
  return {normal(engine), normal(engine), normal(engine)};
}
Vector3<Fixed> to_fixed(const Eigen::Vector3f& v) {
  return {converted<Fixed>(v.x()), converted<Fixed>(v.y()), converted<Fixed>(v.z())};
}
Eigen::Vector3f to_float(const Vector3<Fixed>& v) {
  return {converted<float>(v.x()), converted<float>(v.y()), converted<float>(v.z())};
}

TEST(Normalized, IsAUnitVectorForAnyLength) {
  std::mt19937 engine(1);
  for (const float scale : {1e-6F, 1e-3F, 1.0F, 50.0F}) {
    for (int i = 0; i < 500; ++i) {
      const Vector3<Fixed> v = to_fixed(random_vector(engine, scale));
      if (v == Vector3<Fixed>::Zero()) continue;
      const Eigen::Vector3f unit = to_float(normalized(v));
      ASSERT_LT((unit - to_float(v).normalized()).norm(), 2e-7F) << to_float(v).transpose();
    }
  }
  EXPECT_EQ(normalized(Vector3<Fixed>(Vector3<Fixed>::Zero())), Vector3<Fixed>(Vector3<Fixed>::Zero()));
  EXPECT_EQ(normalized(Eigen::Vector3f(Eigen::Vector3f::Zero())), Eigen::Vector3f(Eigen::Vector3f::Zero()));
}

TEST(Motion, FixedPointAgreesWithFloat) {
  std::mt19937 engine(2);
  Eigen::Matrix3f shape;
  shape << 0.7F, 0.1F, -0.05F, 0.1F, 1.1F, 0.02F, -0.05F, 0.02F, 1.2F;
  Inertia<float> inertia;
  Inertia<Fixed> fixed_inertia;
  ASSERT_TRUE(make_inertia<float>(shape, inertia));
  ASSERT_TRUE(make_inertia<Fixed>(converted<Fixed>(shape), fixed_inertia));
  EXPECT_LT((converted<float>(fixed_inertia.inverse_trf) - inertia.inverse_trf).norm(), 2e-6F);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Matrix3f start =
        Eigen::AngleAxisf(2.0F, random_vector(engine, 1.0F).normalized()).toRotationMatrix();
    const Eigen::Vector3f rate = random_vector(engine, 0.5F);
    const Motion<float> later = propagate<float>({start, rate}, inertia);
    const Motion<Fixed> fixed_later =
        propagate<Fixed>({converted<Fixed>(start), to_fixed(rate)}, fixed_inertia);
    ASSERT_LT((converted<float>(fixed_later.r_lrf_trf) - later.r_lrf_trf).norm(), 5e-6F);
    ASSERT_LT((to_float(fixed_later.rate_lrf) - later.rate_lrf).norm(), 5e-6F);
    const Eigen::Matrix3f turn = rotation_from_vector<float>(rate);
    ASSERT_LT((converted<float>(rotation_from_vector<Fixed>(to_fixed(rate))) - turn).norm(), 2e-6F);
    ASSERT_LT(
        (to_float(small_rotation_vector<Fixed>(converted<Fixed>(turn))) - small_rotation_vector<float>(turn))
            .norm(),
        2e-5F);
  }
}

TEST(MakeInertia, FixedPointAcceptsWhatFloatAccepts) {
  const auto tensor = [](float xx, float yy, float zz, float xy, float xz, float yz) {
    Eigen::Matrix3f j;
    j << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return j;
  };
  const auto is_accepted = [](const Eigen::Matrix3f& shape) {
    Inertia<float> inertia;
    Inertia<Fixed> fixed_inertia;
    const bool accepted = make_inertia<float>(shape, inertia);
    EXPECT_EQ(make_inertia<Fixed>(converted<Fixed>(shape), fixed_inertia), accepted) << shape;
    return accepted;
  };
  const Eigen::Matrix3f good = tensor(0.7F, 1.1F, 1.2F, 0.1F, -0.05F, 0.02F);
  EXPECT_TRUE(is_accepted(good));
  EXPECT_TRUE(is_accepted(tensor(0.02F, 1.49F, 1.49F, 0.0F, 0.0F, 0.0F)));

  for (const auto [row, column] : {std::array{0, 1}, std::array{0, 2}, std::array{1, 2}}) {
    Eigen::Matrix3f asymmetric = good;
    asymmetric(row, column) += 0.01F;
    EXPECT_FALSE(is_accepted(asymmetric)) << row << column;
  }
  // One leading minor at a time is not positive.
  EXPECT_FALSE(is_accepted(tensor(-0.5F, 1.7F, 1.8F, 0.0F, 0.0F, 0.0F)));
  EXPECT_FALSE(is_accepted(tensor(0.5F, -0.5F, 3.0F, 0.0F, 0.0F, 0.0F)));
  EXPECT_FALSE(is_accepted(tensor(0.8F, 0.9F, 1.3F, 0.9F, 0.0F, 0.0F)));
  EXPECT_FALSE(is_accepted(tensor(1.6F, 1.5F, -0.1F, 0.0F, 0.0F, 0.0F)));
  EXPECT_FALSE(is_accepted(tensor(0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F)));
  EXPECT_FALSE(is_accepted(tensor(-1.0F, -1.0F, -1.0F, 0.0F, 0.0F, 0.0F)));
  EXPECT_FALSE(is_accepted(tensor(1e-7F, 1e-7F, 0.0F, 0.0F, 0.0F, 0.0F)));
  // Close to the inertia of a rod.
  EXPECT_FALSE(is_accepted(tensor(0.009F, 1.49F, 1.5F, 0.0F, 0.0F, 0.0F)));
}

TEST(Conversion, MapsNonFiniteToZeroAndSaturates) {
  EXPECT_EQ(converted<Fixed>(std::nanf("")), Fixed());
  EXPECT_EQ(converted<Fixed>(INFINITY), Fixed());
  EXPECT_EQ(converted<Fixed>(1e20F).raw(), Fixed::kLargestRaw);
  EXPECT_EQ(converted<Fixed>(-128.0F).raw(), -Fixed::kLargestRaw);
  EXPECT_EQ(converted<Fixed>(127.99999F).raw(), 2'147'483'520);
  EXPECT_EQ(converted<float>(Fixed(-2.5)), -2.5F);
}

}  // namespace
}  // namespace tumblesight::gnc
