#include "gnc/registration/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/unit/gnc/registration/scene.hpp"

namespace tumblesight::gnc {
namespace {

using Matrix12 = Eigen::Matrix<double, 12, 12>;
constexpr std::int32_t kRadius_um = 2'500'000;

PoseFitResult result_of(const Matrix12& information, double disagreement) {
  PoseFitResult result;
  for (int i = 0; i < kMotionUnknowns; ++i)
    for (int k = 0; k <= i; ++k) result.information[element(i, k)] = std::llround(16.0 * information(i, k));
  result.disagreement_q8 = std::llround(256.0 * disagreement);
  return result;
}

// Of a result in [urad, urad/s, um, um/s].
Matrix12 matrix_of(const PoseCovariance& covariance) {
  Matrix12 matrix;
  std::size_t place = 0;
  for (int i = 0; i < kMotionUnknowns; ++i) {
    const double sigma = covariance.sigma[static_cast<std::size_t>(i)];
    matrix(i, i) = sigma * sigma;
    for (int k = 0; k < i; ++k)
      matrix(i, k) = matrix(k, i) = covariance.correlation_q15[place++] / 32768.0 * sigma *
                                    covariance.sigma[static_cast<std::size_t>(k)];
  }
  return matrix;
}

// Turn and move of ten poses that were measured within `sigma` at equal times: a straight line through ten
// points.
Matrix12 information_of_ten(double sigma_rad, double sigma_radii) {
  Matrix12 information = Matrix12::Zero();
  for (int age = 0; age < 10; ++age) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const auto& [first, sigma] : {std::pair{0, sigma_rad}, std::pair{6, sigma_radii}}) {
        const int now = first + axis, rate = first + 3 + axis;
        information(now, now) += 1.0 / (sigma * sigma);
        information(now, rate) -= age / (sigma * sigma);
        information(rate, now) -= age / (sigma * sigma);
        information(rate, rate) += age * age / (sigma * sigma);
      }
    }
  }
  return information;
}

TEST(PoseCovariance, IsTheInverseOfTheInformationInTheUnitsOfTheInterface) {
  const Matrix12 information = information_of_ten(0.01, 0.02);
  Matrix12 units = Matrix12::Zero();
  for (int i = 0; i < 12; ++i) units(i, i) = (i < 6 ? 1e6 : kRadius_um) / (i % 6 >= 3 ? 2.7 : 1.0);
  const Matrix12 expected = units * information.inverse() * units;
  PoseCovariance covariance;
  // Ten poses that disagree by d, and five usual ones (0.15), over 13.
  const double disagreement = 0.5;
  make_covariance(result_of(information, disagreement), 10, kRadius_um, covariance);
  const double scale = 5.0 * 1.8 * std::pow((10.0 * disagreement + 3.0 * 38.0 / 256.0) / 11.0, 2.0);
  const Matrix12 found = matrix_of(covariance);
  for (int i = 0; i < 12; ++i)
    for (int k = 0; k < 12; ++k)
      EXPECT_NEAR(found(i, k), scale * expected(i, k),
                  0.04 * scale * std::sqrt(expected(i, i) * expected(k, k)))
          << i << ' ' << k;
}

TEST(PoseCovariance, HasAFloor) {
  PoseCovariance covariance;
  make_covariance(result_of(information_of_ten(1e-4, 1e-4), 0.0), 10, kRadius_um, covariance);
  const std::array<double, 4> floor{525.0, 60.0, 2000.0, 300.0};
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_GE(covariance.sigma[i], floor[i / 3]) << i;
    EXPECT_LT(covariance.sigma[i], 1.3 * floor[i / 3]) << i;
  }
}

TEST(PoseCovariance, MorePosesAndLessDisagreementKnowMore) {
  PoseCovariance few, many, worse;
  const PoseFitResult result = result_of(information_of_ten(0.01, 0.02), 0.2);
  make_covariance(result, 3, kRadius_um, few);
  make_covariance(result, 10, kRadius_um, many);
  make_covariance(result_of(information_of_ten(0.01, 0.02), 2.0), 10, kRadius_um, worse);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_LT(many.sigma[i], few.sigma[i]) << i;
    EXPECT_LT(many.sigma[i], worse.sigma[i]) << i;
  }
}

// Nothing is known: large numbers, and no overflow.
TEST(PoseCovariance, OfNoInformationIsLarge) {
  PoseCovariance covariance;
  make_covariance(result_of(Matrix12::Zero(), 65536.0), 1, kRadius_um, covariance);
  for (const std::uint32_t sigma : covariance.sigma) EXPECT_GT(sigma, 1'000'000U);
}

}  // namespace
}  // namespace tumblesight::gnc
