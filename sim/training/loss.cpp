#include "sim/training/loss.hpp"

#include "gnc/rcnn/network_shape.hpp"
#include "sim/training/rcnn_module.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;

namespace {
constexpr double kLogitWeight = 0.3;
constexpr double kErrorWeight = 0.1;
constexpr double kAsGood_rad = 2.0 * kRadPerDeg;

torch::Tensor expected_error_loss(const torch::Tensor& logit, const torch::Tensor& error_rad) {
  return torch::binary_cross_entropy_with_logits(logit, (error_rad.detach() / kPi).clamp(0.0, 1.0));
}
}  // namespace

torch::Tensor angle_between(const torch::Tensor& a, const torch::Tensor& b) {
  // |R1 - R2|_F = 2 sqrt(2) sin(angle / 2).
  const torch::Tensor sine_squared = ((a - b).square().sum({-1, -2}) / 8.0).clamp(0.0, 1.0);
  return 2.0 * torch::atan2((sine_squared + 1e-8).sqrt(), (1.0 - sine_squared + 1e-6).sqrt());
}

HypothesisErrors hypothesis_errors(const torch::Tensor& output, const torch::Tensor& r_lrf_trf) {
  const torch::Tensor columns = orthonormal_columns(output);  // [..., 8, 2, 3]
  const torch::Tensor x3 = torch::cross(columns.select(-2, 0), columns.select(-2, 1), -1);
  const torch::Tensor rotation = torch::cat({columns, x3.unsqueeze(-2)}, -2);  // rows are the columns of R
  const torch::Tensor truth = r_lrf_trf.transpose(-1, -2).unsqueeze(-3);       // the same for the truth
  HypothesisErrors errors;
  errors.angle_rad = angle_between(rotation, truth);
  errors.best_rad = std::get<0>(errors.angle_rad.min(-1));
  const torch::Tensor chosen = output.narrow(-1, shape::kColumns, shape::kHypotheses).argmax(-1, true);
  errors.chosen_rad = errors.angle_rad.gather(-1, chosen).squeeze(-1);
  return errors;
}

torch::Tensor hypothesis_loss(const torch::Tensor& output, const HypothesisErrors& errors, double spread) {
  const torch::Tensor log_probability =
      torch::log_softmax(output.narrow(-1, shape::kColumns, shape::kHypotheses), -1);
  const torch::Tensor best_index = errors.angle_rad.detach().argmin(-1, true);
  const torch::Tensor logit_loss = -log_probability.gather(-1, best_index).mean();
  const torch::Tensor error_loss =
      expected_error_loss(output.select(-1, shape::kOutput - 1), errors.chosen_rad);
  return (1.0 - spread) * errors.best_rad.mean() + spread * errors.angle_rad.mean() +
         kLogitWeight * logit_loss + kErrorWeight * error_loss;
}

torch::Tensor tracking_loss(const TrackedSequences& tracked, const torch::Tensor& r_lrf_trf) {
  const torch::Tensor errors = angle_between(tracked.cluster_means, r_lrf_trf.unsqueeze(2));  // [B, T, 9]
  const torch::Tensor best = std::get<0>(errors.min(-1));
  const torch::Tensor worse = (errors > best.unsqueeze(-1) + kAsGood_rad).detach();
  const torch::Tensor log_probability = torch::log_softmax(tracked.anchor_logits, -1);
  const torch::Tensor choice_loss = -torch::logsumexp(log_probability.masked_fill(worse, -1e9), -1).mean();
  const torch::Tensor error_loss =
      expected_error_loss(tracked.error_logits, angle_between(tracked.r_lrf_trf, r_lrf_trf));
  return best.mean() + kLogitWeight * choice_loss + kErrorWeight * error_loss;
}

}  // namespace tumblesight::sim
