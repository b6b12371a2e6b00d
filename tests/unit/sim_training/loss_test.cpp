// Requirement: the trained error is the geodesic angle, with usable gradients everywhere.
#include "sim/training/loss.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {
namespace {
namespace shape = gnc::shape;

torch::Tensor matrix(const Eigen::Matrix3f& r) {
  torch::Tensor t = torch::empty({3, 3});
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) t[i][j] = r(i, j);
  }
  return t;
}

// An output whose hypothesis k is `r` (columns scaled and sheared: only their directions may count).
void set_hypothesis(torch::Tensor& output, int k, const Eigen::Matrix3f& r) {
  const Eigen::Vector3f a = 2.0F * r.col(0), b = 0.5F * r.col(1) + 0.7F * r.col(0);
  for (int i = 0; i < 3; ++i) {
    output[0][6 * k + i] = a[i];
    output[0][6 * k + 3 + i] = b[i];
  }
}

TEST(HypothesisErrors, AreTheGeodesicAngles) {
  const Eigen::Matrix3f truth = Eigen::Quaternionf(0.5F, 0.1F, -0.7F, 0.3F).normalized().toRotationMatrix();
  torch::Tensor output = torch::zeros({1, shape::kOutput});
  const Eigen::Vector3f axis = Eigen::Vector3f(1, 2, -1).normalized();
  for (int k = 0; k < shape::kHypotheses; ++k) {
    set_hypothesis(output, k, Eigen::AngleAxisf(0.4F * static_cast<float>(k), axis) * truth);
  }
  output[0][shape::kColumns + 5] = 1.0;  // the chosen one
  const HypothesisErrors errors = hypothesis_errors(output, matrix(truth).unsqueeze(0));
  for (int k = 0; k < shape::kHypotheses; ++k)
    EXPECT_NEAR(errors.angle_rad[0][k].item<float>(), 0.4 * k, 3e-3);
  EXPECT_NEAR(errors.best_rad.item<float>(), 0.0, 1e-3);
  EXPECT_NEAR(errors.chosen_rad.item<float>(), 2.0, 1e-3);
}

TEST(HypothesisLoss, HasFiniteGradientsAtNoErrorAndAtHalfATurn) {
  for (const float angle : {0.0F, 3.14159265F}) {
    torch::Tensor output = torch::zeros({1, shape::kOutput});
    const Eigen::Matrix3f turned(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
    for (int k = 0; k < shape::kHypotheses; ++k) set_hypothesis(output, k, turned);
    output.requires_grad_();
    hypothesis_loss(output, hypothesis_errors(output, torch::eye(3).unsqueeze(0)), 0.1).backward();
    EXPECT_TRUE(torch::isfinite(output.grad()).all().item<bool>()) << angle;
    EXPECT_LT(output.grad().abs().max().item<float>(), 100.0F) << angle;
  }
}

TEST(HypothesisLoss, FallsWhenTheLogitsNameTheBestHypothesis) {
  torch::manual_seed(1);
  torch::Tensor output = torch::randn({1, shape::kOutput});
  const HypothesisErrors errors = hypothesis_errors(output, torch::eye(3).unsqueeze(0));
  const double before = hypothesis_loss(output, errors, 0.02).item<double>();
  output[0][shape::kColumns + errors.angle_rad.argmin().item<int>()] += 3.0;
  EXPECT_LT(hypothesis_loss(output, errors, 0.02).item<double>(), before);
}

}  // namespace
}  // namespace tumblesight::sim
