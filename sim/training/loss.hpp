// What the networks are trained for: several attitude hypotheses with probabilities, and an honest expected
// error.
#pragma once

#include <torch/torch.h>

#include "sim/training/rcnn_module.hpp"

namespace tumblesight::sim {

struct HypothesisErrors {
  torch::Tensor angle_rad;   // [..., 8] geodesic error of each hypothesis
  torch::Tensor best_rad;    // [...] the smallest
  torch::Tensor chosen_rad;  // [...] of the one with the largest logit: what the flight network answers
};

// output [..., 57], r_lrf_trf [..., 3, 3].
HypothesisErrors hypothesis_errors(const torch::Tensor& output, const torch::Tensor& r_lrf_trf);

// Winner-takes-most: (1 - spread) x best + spread x mean of all, + 0.3 x cross-entropy of the logits on the
// best one,
// + 0.1 x binary cross-entropy of the error logit on the chosen one's error over pi. A symmetric target then
// keeps its alternatives apart instead of being blurred into their mean. `spread` keeps unused hypotheses
// alive early on.
torch::Tensor hypothesis_loss(const torch::Tensor& output, const HypothesisErrors& errors, double spread);

// The recurrent part, likewise: error of the best cluster, + 0.3 x cross-entropy of choosing one as good as
// the best (within 2 degrees), + 0.1 x cross-entropy of the expected error on the answer's. All frames count
// alike.
torch::Tensor tracking_loss(const TrackedSequences& tracked, const torch::Tensor& r_lrf_trf);

// Geodesic distance of rotations [..., 3, 3] in radians, with a gradient that stays finite at both ends.
torch::Tensor angle_between(const torch::Tensor& a, const torch::Tensor& b);

}  // namespace tumblesight::sim
