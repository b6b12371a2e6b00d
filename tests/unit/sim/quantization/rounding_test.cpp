// Verifies TS-TRN-020.
// Weights are rounded to nearest if their inputs are independent, and to preserve the sum if they are
// correlated.
#include "sim/quantization/rounding.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tumblesight::sim {
namespace {

constexpr int kInputs = 24;
constexpr int kChannels = 6;

Eigen::MatrixXd random_weights(unsigned seed, double largest) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-largest, largest);
  return Eigen::MatrixXd::NullaryExpr(kInputs, kChannels, [&] { return uniform(engine); });
}

// Mean square of the change in the sums, for inputs of this covariance.
double squared_error(const Eigen::MatrixXd& exact, const Eigen::MatrixXd& integers,
                     const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd error = exact - integers;
  return (error.transpose() * covariance * error).trace();
}

TEST(InputStatistics, GiveMeanAndCovarianceOfTheSamples) {
  InputStatistics statistics(2);
  statistics.add({1.0, 0.0});
  statistics.add({3.0, 4.0});
  EXPECT_TRUE(statistics.mean().isApprox(Eigen::Vector2d(2.0, 2.0)));
  Eigen::Matrix2d expected;
  expected << 1.0, 2.0, 2.0, 4.0;
  EXPECT_TRUE(statistics.covariance().isApprox(expected)) << statistics.covariance();
}

TEST(RoundedWeights, AreTheNearestForIndependentInputs) {
  const Eigen::MatrixXd weights = random_weights(1, 100.0);
  const Eigen::MatrixXd integers =
      rounded_weights(weights, Eigen::MatrixXd::Identity(kInputs, kInputs), 127.0);
  EXPECT_TRUE(integers.isApprox(weights.array().round().matrix()));
}

TEST(RoundedWeights, ChangeTheSumLessThanTheNearestForCorrelatedInputs) {
  const Eigen::MatrixXd weights = random_weights(2, 5.0);
  const Eigen::MatrixXd mixing = random_weights(3, 1.0);  // few sources behind many inputs
  const Eigen::MatrixXd covariance =
      mixing * mixing.transpose() + 0.01 * Eigen::MatrixXd::Identity(kInputs, kInputs);
  const double nearest = squared_error(weights, weights.array().round().matrix(), covariance);
  EXPECT_LT(squared_error(weights, rounded_weights(weights, covariance, 127.0), covariance), 0.3 * nearest);
}

TEST(RoundedWeights, AreWithinTheLimitEvenIfEarlierWeightsSaturated) {
  const Eigen::MatrixXd weights = random_weights(4, 400.0);
  const Eigen::MatrixXd covariance =
      Eigen::MatrixXd::Ones(kInputs, kInputs) + Eigen::MatrixXd::Identity(kInputs, kInputs);
  const Eigen::MatrixXd integers = rounded_weights(weights, covariance, 127.0);
  EXPECT_LE(integers.cwiseAbs().maxCoeff(), 127.0);
  EXPECT_TRUE(integers.isApprox(integers.array().round().matrix()));
}

TEST(RoundedWeights, AreIntegersEvenIfAllInputsAreZero) {
  const Eigen::MatrixXd weights = random_weights(5, 50.0);
  const Eigen::MatrixXd integers = rounded_weights(weights, Eigen::MatrixXd::Zero(kInputs, kInputs), 127.0);
  EXPECT_TRUE(integers.isApprox(weights.array().round().matrix()));
}

}  // namespace
}  // namespace tumblesight::sim
