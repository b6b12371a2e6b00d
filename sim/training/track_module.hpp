// gnc/rcnn/attitude_track.hpp in LibTorch, for batches and with gradients. The flight code must give the same
// numbers (tests/unit/sim/training proves it).
#pragma once

#include <torch/torch.h>

#include "gnc/rcnn/attitude_track.hpp"

namespace tumblesight::sim {

// From two columns [..., 3] each, by Gram-Schmidt: [..., 3, 3].
torch::Tensor rotation_from_columns(const torch::Tensor& a, const torch::Tensor& b);

struct FrameHypotheses {
  FrameHypotheses(const torch::Tensor& features, const torch::Tensor& r_lrf_trf, const torch::Tensor& logits);
  torch::Tensor features;       // [B, 128]
  torch::Tensor r_lrf_trf;      // [B, 8, 3, 3]
  torch::Tensor logits;         // [B, 8]
  torch::Tensor probabilities;  // [B, 8]
};

struct Fusion {
  torch::Tensor r_lrf_trf;      // [B, 3, 3]
  torch::Tensor cluster_means;  // [B, 9, 3, 3]
  torch::Tensor anchor_logits;  // [B, 9]
  torch::Tensor error_logit;    // [B]
};

// One track a row of the batch. For every frame: predict(), lstm_input(), advance().
class TrackModule {
 public:
  explicit TrackModule(const gnc::Inertia<float>& inertia) : laws_(gnc::motion_laws<float>(inertia)) {}
  void predict(const FrameHypotheses& frame);
  torch::Tensor lstm_input(const FrameHypotheses& frame) const;  // [B, 190]
  Fusion advance(const FrameHypotheses& frame, const torch::Tensor& word);

 private:
  torch::Tensor standing() const;  // log-likelihood less the evidence asked [B, 5]
  torch::Tensor law() const;       // the one that speaks [B]

  gnc::MotionLaws<float> laws_;
  int frames_ = 0;
  // By each law of motion; after predict() in the frame to come, after advance() in the frame that was.
  torch::Tensor r_lrf_trf_, rate_lrf_;  // [B, 5, 3, 3], [B, 5, 3]
  torch::Tensor log_likelihood_;        // [B, 5]
};

}  // namespace tumblesight::sim
