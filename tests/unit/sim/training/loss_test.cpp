// The losses are built on the geodesic angle and have finite gradients everywhere.
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

// Sets hypothesis k to `r`, with scaled and sheared columns: only the orthonormalized columns may matter.
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

TEST(HypothesisLoss, DecreasesIfTheLogitsPreferTheBestHypothesis) {
  torch::manual_seed(1);
  torch::Tensor output = torch::randn({1, shape::kOutput});
  const HypothesisErrors errors = hypothesis_errors(output, torch::eye(3).unsqueeze(0));
  const double before = hypothesis_loss(output, errors, 0.02).item<double>();
  output[0][shape::kColumns + errors.angle_rad.argmin().item<int>()] += 3.0;
  EXPECT_LT(hypothesis_loss(output, errors, 0.02).item<double>(), before);
}

constexpr double kHalfTurn_rad = 3.14159265358979;

torch::Tensor turned_by(double angle_rad) {
  return matrix(Eigen::Matrix3f(
      Eigen::AngleAxisf(static_cast<float>(angle_rad), Eigen::Vector3f(1, 2, -1).normalized())));
}

// One sequence of two frames; the truth is the identity. Of the nine clusters, 2 is the best by 0.1 rad and 5
// is within 1 degree of it. The estimate is that of cluster 7, with an error of 0.8 rad.
struct Tracked {
  TrackedSequences sequences;
  torch::Tensor truth = torch::eye(3).expand({1, 2, 3, 3}).clone();

  Tracked() {
    std::vector<torch::Tensor> clusters;
    for (int i = 0; i < shape::kCandidates; ++i) {
      clusters.push_back(turned_by(i == 2 ? 0.2 : i == 5 ? 0.217 : 0.3 + 0.1 * (i == 7 ? 5 : i)));
    }
    sequences.cluster_means = torch::stack(clusters).expand({1, 2, shape::kCandidates, 3, 3}).clone();
    sequences.r_lrf_trf = turned_by(0.8).expand({1, 2, 3, 3}).clone();
    sequences.anchor_logits = torch::zeros({1, 2, shape::kCandidates});
    sequences.error_logits = torch::zeros({1, 2});
  }
};

TEST(TrackingLoss, EqualsItsClosedForm) {
  Tracked t;
  t.sequences.anchor_logits[0][0][2] = 1.0;  // frame 0: p = (e + 1) / (e + 8) that the choice is good
  t.sequences.anchor_logits[0][1][7] = 2.0;  // frame 1: 2 / (e^2 + 8)
  t.sequences.error_logits[0][1] = -1.5;
  const double choice = -0.5 * (std::log((std::exp(1.0) + 1.0) / (std::exp(1.0) + 8.0)) +
                                std::log(2.0 / (std::exp(2.0) + 8.0)));
  const double p = 1.0 / (1.0 + std::exp(1.5));
  const double error = 0.8 / kHalfTurn_rad;
  const double expected_error =
      0.5 * (std::log(2.0) - error * std::log(p) - (1.0 - error) * std::log(1.0 - p));
  EXPECT_NEAR(tracking_loss(t.sequences, t.truth).item<double>(), 0.2 + 0.3 * choice + 0.1 * expected_error,
              1e-4);
}

TEST(TrackingLoss, TreatsAllGoodClustersAlikeAndPrefersThemToTheOthers) {
  Tracked best, as_good, bad, none;
  best.sequences.anchor_logits.select(-1, 2) += 3.0;
  as_good.sequences.anchor_logits.select(-1, 5) += 3.0;
  bad.sequences.anchor_logits.select(-1, 7) += 3.0;
  const auto loss = [](const Tracked& t) { return tracking_loss(t.sequences, t.truth).item<double>(); };
  EXPECT_NEAR(loss(best), loss(as_good), 1e-6);
  EXPECT_LT(loss(best), loss(none) - 0.1);
  EXPECT_GT(loss(bad), loss(none) + 0.1);
}

TEST(TrackingLoss, IsMinimalIfTheErrorLogitStatesTheError) {
  Tracked t;
  t.sequences.error_logits.fill_(std::log(0.8 / (kHalfTurn_rad - 0.8)));
  t.sequences.error_logits.requires_grad_();
  tracking_loss(t.sequences, t.truth).backward();
  EXPECT_LT(t.sequences.error_logits.grad().abs().max().item<double>(), 1e-5);
}

TEST(TrackingLoss, HasFiniteGradientsAtNoErrorAndAtHalfATurn) {
  for (const double angle_rad : {0.0, kHalfTurn_rad}) {
    Tracked t;
    t.sequences.cluster_means = turned_by(angle_rad).expand({1, 2, shape::kCandidates, 3, 3}).clone();
    t.sequences.cluster_means.requires_grad_();
    t.sequences.r_lrf_trf = t.sequences.cluster_means.select(2, 0);
    tracking_loss(t.sequences, t.truth).backward();
    const torch::Tensor gradient = t.sequences.cluster_means.grad();
    EXPECT_TRUE(torch::isfinite(gradient).all().item<bool>()) << angle_rad;
    EXPECT_LT(gradient.abs().max().item<double>(), 100.0) << angle_rad;
  }
}

}  // namespace
}  // namespace tumblesight::sim
