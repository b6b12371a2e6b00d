// gnc/rcnn/attitude_track.hpp in LibTorch: for batches, with gradients. The flight code gives the same values
// (tests/unit/sim/training/export_test.cpp) as long as the chaser does not turn and two frames are close
// enough in time to tell the rate (gnc::kLongestToFindRate_ns).
//
// Shapes: B rows of a batch, 8 hypotheses, 9 candidates, 5 motion models.
#pragma once

#include <torch/torch.h>

#include "gnc/rcnn/attitude_track.hpp"

namespace tumblesight::sim {

// Gram-Schmidt orthonormalization of two columns [..., 3] each; the third is their cross product: [..., 3,
// 3].
torch::Tensor rotation_from_columns(const torch::Tensor& a, const torch::Tensor& b);

// The CNN's output for one frame.
struct FrameHypotheses {
  FrameHypotheses(const torch::Tensor& features, const torch::Tensor& r_lrf_trf, const torch::Tensor& logits,
                  const torch::Tensor& periods);
  torch::Tensor features;       // [B, 128]
  torch::Tensor r_lrf_trf;      // [B, 8, 3, 3]
  torch::Tensor logits;         // [B, 8]
  torch::Tensor probabilities;  // [B, 8]
  torch::Tensor periods;        // [B], since the frame before
};

// The estimate for one frame; as TrackedSequences, without T.
struct Fusion {
  torch::Tensor r_lrf_trf;      // [B, 3, 3]
  torch::Tensor cluster_means;  // [B, 9, 3, 3]
  torch::Tensor anchor_logits;  // [B, 9]
  torch::Tensor error_logit;    // [B]
};

// One track per row of the batch. For every frame call predict(), lstm_input() and advance(), in this order.
class TrackModule {
 public:
  explicit TrackModule(const gnc::Inertia<float>& inertia)
      : motion_models_(gnc::motion_models<float>(inertia)) {}
  void predict(const FrameHypotheses& frame);
  torch::Tensor lstm_input(const FrameHypotheses& frame) const;  // [B, 190]
  // `head_output`: of the recurrent head [B, 20].
  Fusion advance(const FrameHypotheses& frame, const torch::Tensor& head_output);

 private:
  torch::Tensor standing()
      const;  // log-likelihood minus the evidence required (gnc::kRequiredEvidence) [B, 5]
  torch::Tensor motion_model() const;  // index of the motion model with the highest standing [B]

  gnc::MotionModels<float> motion_models_;
  int frames_ = 0;
  // Per motion model. After predict() they refer to the coming frame, after advance() to the frame just
  // processed.
  torch::Tensor r_lrf_trf_, rate_lrf_;  // [B, 5, 3, 3], [B, 5, 3]
  torch::Tensor log_likelihood_;        // [B, 5]
};

}  // namespace tumblesight::sim
