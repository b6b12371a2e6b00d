// Losses of both training stages. They train several attitude hypotheses with probabilities, and a calibrated
// expected error.
#pragma once

#include <torch/torch.h>

#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

struct HypothesisErrors {
  torch::Tensor angle_rad;  // [..., 8] geodesic error of each hypothesis
  torch::Tensor best_rad;   // [...] of the best hypothesis
  torch::Tensor
      chosen_rad;  // [...] of the hypothesis with the largest logit, which the CNN alone would report
};

// output: of the CNN [..., 57]; r_lrf_trf: truth [..., 3, 3], in the frame of the hypotheses.
HypothesisErrors hypothesis_errors(const torch::Tensor& output, const torch::Tensor& r_lrf_trf);

// (1 - spread) * error of the best hypothesis + spread * mean error of all + 0.3 * cross-entropy of the
// logits with the best hypothesis + 0.1 * binary cross-entropy of the error logit with the chosen
// hypothesis's error over pi. Training mainly the best hypothesis keeps the alternatives of a symmetric
// target apart instead of averaging them. `spread` (0 to 1) keeps unused hypotheses in training early on.
torch::Tensor hypothesis_loss(const torch::Tensor& output, const HypothesisErrors& errors, double spread);

// The same for the recurrent part, over all frames with equal weight: error of the best cluster + 0.3 *
// cross-entropy of choosing a cluster within 2 degrees of the best + 0.1 * binary cross-entropy of the error
// logit with the estimate's error over pi. r_lrf_trf: truth [B, T, 3, 3].
torch::Tensor tracking_loss(const TrackedSequences& tracked, const torch::Tensor& r_lrf_trf);

// Geodesic distance of rotations [..., 3, 3] in radians. Its gradient is finite at 0 and at pi.
torch::Tensor angle_between(const torch::Tensor& a, const torch::Tensor& b);

}  // namespace tumblesight::sim
