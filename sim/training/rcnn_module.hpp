// The network as LibTorch modules, for training. Its layers are those of gnc/rcnn/network_shape.hpp, and the
// flight network gives the same values (tests/unit/sim/training/export_test.cpp).
//
// Shapes: B rows of a batch, T frames of a sequence.
#pragma once

#include <torch/torch.h>

#include <array>
#include <vector>

#include "gnc/attitude/motion.hpp"
#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {

// The convolutions, each without bias and followed by pooling, batch norm and ReLU. The norm has a learned
// offset but no gain, since the next layer's weights can take over a positive gain. Without a gain,
// max-pooling before the norm equals max-pooling after it, on a quarter of the elements.
class BackboneImpl : public torch::nn::Module {
 public:
  BackboneImpl();
  // images [B, 1, 100, 100] -> flattened image [B, 1440], channel by channel. `fast`: in bfloat16, except for
  // the result.
  torch::Tensor forward(const torch::Tensor& images, bool fast);

  static constexpr int kStages = gnc::kImageLayerCount;
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
  torch::Tensor features;  // [B, 128] output of the last hidden layer
  torch::Tensor output;    // [B, 57]
};

class CnnImpl : public torch::nn::Module {
 public:
  CnnImpl();
  CnnOutput forward(const torch::Tensor& images, bool fast);

  Backbone backbone{nullptr};
  std::vector<torch::nn::Linear> dense;  // in the table's order; the last one is the single-frame head
};
TORCH_MODULE(Cnn);

// Hypotheses of an output [..., 57] as orthonormalized columns x1, x2 [..., 8, 2, 3].
torch::Tensor orthonormal_columns(const torch::Tensor& output);

// The CNN's output for whole sequences, as in gnc::Hypotheses.
struct SequenceHypotheses {
  torch::Tensor features;   // [B, T, 128]
  torch::Tensor r_lrf_trf;  // [B, T, 8, 3, 3]
  torch::Tensor logits;     // [B, T, 8]
  torch::Tensor periods;    // [B, T], time since the frame before, in nominal periods; 1 for the first frame
};

// The recurrent part's output. Every candidate (the frame's hypotheses and the predicted attitude) represents
// the cluster of candidates around it.
struct TrackedSequences {
  torch::Tensor r_lrf_trf;      // [B, T, 3, 3] the estimate
  torch::Tensor cluster_means;  // [B, T, 9, 3, 3] the estimate if each candidate were chosen as the anchor
  torch::Tensor anchor_logits;  // [B, T, 9]
  torch::Tensor error_logits;   // [B, T]
  torch::Tensor inputs;         // [B, T, 190] of the LSTM, not standardized, without gradient
};

// LSTM, recurrent head and attitude track (gnc/rcnn/attitude_track.hpp) over sequences of targets with the
// same inertia.
class RecurrentImpl : public torch::nn::Module {
 public:
  explicit RecurrentImpl(const gnc::Inertia<float>& inertia = {});
  TrackedSequences forward(const SequenceHypotheses& sequences);
  // Mean and standard deviation of the LSTM input [190]. A deviation below 0.01 counts as 0.01.
  void set_standardisation(const torch::Tensor& input_mean, const torch::Tensor& input_deviation);

  torch::nn::LSTMCell lstm{nullptr};
  std::vector<torch::nn::Linear> head;        // in the table's order
  torch::Tensor input_mean, input_deviation;  // [190]

 private:
  torch::Tensor head_output(torch::Tensor x);  // [B, hidden state and LSTM input] -> [B, 20]

  gnc::Inertia<float> inertia_;
};
TORCH_MODULE(Recurrent);

}  // namespace tumblesight::sim
