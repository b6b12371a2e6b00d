// The network as LibTorch modules, for training. Shapes and semantics are those of
// gnc/rcnn/network_shape.hpp; the flight network must give the same numbers (tests/unit/sim/training proves
// it).
#pragma once

#include <torch/torch.h>

#include <array>

#include "gnc/attitude/motion.hpp"

namespace tumblesight::sim {

// Convolution without bias, then (pooling and) batch norm with a learned offset and no gain: the next layer's
// weights can take a positive gain up, and without one max-pooling before the norm equals pooling after it,
// on a quarter of the elements.
class BackboneImpl : public torch::nn::Module {
 public:
  BackboneImpl();
  // images [B, 1, 100, 100] -> features [B, 2160] in CHW order. `fast`: convolve in bfloat16, the rest in
  // what follows.
  torch::Tensor forward(const torch::Tensor& images, bool fast);

  static constexpr int kStages = 4;
  std::array<torch::Tensor, kStages> weight;  // [out, in, 3, 3]
  std::array<torch::Tensor, kStages> offset;  // batch norm's beta
  std::array<torch::Tensor, kStages> mean;    // running statistics
  std::array<torch::Tensor, kStages> variance;
  static constexpr double kEpsilon = 1e-5;

 private:
  std::array<torch::Tensor, kStages> gain_;  // constant 1
};
TORCH_MODULE(Backbone);

struct CnnOutput {
  torch::Tensor dense2;  // [B, 128]
  torch::Tensor output;  // [B, 57]
};

class CnnImpl : public torch::nn::Module {
 public:
  CnnImpl();
  CnnOutput forward(const torch::Tensor& images, bool fast);

  Backbone backbone{nullptr};
  torch::nn::Linear dense1{nullptr}, dense2{nullptr}, output{nullptr};
};
TORCH_MODULE(Cnn);

// Hypotheses of an output [..., 57] as orthonormalised columns x1, x2 [..., 8, 2, 3].
torch::Tensor orthonormal_columns(const torch::Tensor& output);

// What the CNN says of whole sequences, as gnc::Hypotheses holds it.
struct SequenceHypotheses {
  torch::Tensor features;   // [B, T, 128] dense2's output
  torch::Tensor r_lrf_trf;  // [B, T, 8, 3, 3]
  torch::Tensor logits;     // [B, T, 8]
};

// What the recurrent part makes of them. Every candidate (the frame's hypotheses and the predicted attitude)
// stands for the cluster around it.
struct TrackedSequences {
  torch::Tensor r_lrf_trf;      // [B, T, 3, 3] the answer
  torch::Tensor cluster_means;  // [B, T, 9, 3, 3] what the answer would be with each candidate as the anchor
  torch::Tensor anchor_logits;  // [B, T, 9]
  torch::Tensor error_logits;   // [B, T]
  torch::Tensor inputs;         // [B, T, 190] the LSTM's, not standardised, without gradient
};

// LSTM, recurrent head and attitude track (gnc/rcnn/attitude_track.hpp) over sequences of targets of one
// inertia.
class RecurrentImpl : public torch::nn::Module {
 public:
  explicit RecurrentImpl(const gnc::Inertia<float>& inertia = {});
  TrackedSequences forward(const SequenceHypotheses& sequences);
  void set_standardisation(const torch::Tensor& input_mean, const torch::Tensor& input_deviation);

  torch::nn::LSTMCell lstm{nullptr};
  torch::nn::Linear head1{nullptr}, head2{nullptr};
  torch::Tensor input_mean, input_deviation;  // [190]

 private:
  gnc::Inertia<float> inertia_;
};
TORCH_MODULE(Recurrent);

}  // namespace tumblesight::sim
