// The network as LibTorch modules, for training. Shapes and semantics are those of
// gnc/rcnn/network_shape.hpp; the flight network must give the same numbers (tests/unit/sim_training proves
// it).
#pragma once

#include <torch/torch.h>

#include <array>

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
// The LSTM's input [..., 184] from dense2's and the head's output.
torch::Tensor lstm_input(const torch::Tensor& dense2, const torch::Tensor& output);

// LSTM and recurrent head over sequences of single-frame results.
class RecurrentImpl : public torch::nn::Module {
 public:
  RecurrentImpl();
  // dense2 [B, T, 128], single-frame output [B, T, 57] -> output [B, T, 57].
  torch::Tensor forward(const torch::Tensor& dense2, const torch::Tensor& single_frame_output);
  void set_standardisation(const torch::Tensor& input_mean, const torch::Tensor& input_deviation);

  torch::nn::LSTM lstm{nullptr};
  torch::nn::Linear head1{nullptr}, head2{nullptr};
  torch::Tensor input_mean, input_deviation;  // [184]
};
TORCH_MODULE(Recurrent);

}  // namespace tumblesight::sim
