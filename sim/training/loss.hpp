// What the networks are trained for: several attitude hypotheses with probabilities, and an honest expected
// error.
#pragma once

#include <torch/torch.h>

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

}  // namespace tumblesight::sim
