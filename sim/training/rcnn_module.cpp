#include "sim/training/rcnn_module.hpp"

#include <cmath>
#include <string>

#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace F = torch::nn::functional;

namespace {
constexpr std::array<int, BackboneImpl::kStages + 1> kChannels = {
    shape::kSpaceToDepthChannels, shape::kConv1, shape::kConv2, shape::kConv3, shape::kConv4};
constexpr double kMomentum = 0.05;
}  // namespace

BackboneImpl::BackboneImpl() {
  for (int i = 0; i < kStages; ++i) {
    const std::string stage = std::to_string(i + 1);
    const double he = std::sqrt(2.0 / (9.0 * kChannels[i]));
    weight[i] =
        register_parameter("weight" + stage, torch::randn({kChannels[i + 1], kChannels[i], 3, 3}) * he);
    offset[i] = register_parameter("offset" + stage, torch::zeros({kChannels[i + 1]}));
    mean[i] = register_buffer("mean" + stage, torch::zeros({kChannels[i + 1]}));
    variance[i] = register_buffer("variance" + stage, torch::ones({kChannels[i + 1]}));
    gain_[i] = register_buffer("gain" + stage, torch::ones({kChannels[i + 1]}));
  }
}

torch::Tensor BackboneImpl::forward(const torch::Tensor& images, bool fast) {
  const auto type = fast ? torch::kBFloat16 : torch::kFloat;
  const auto layout = torch::MemoryFormat::ChannelsLast;
  torch::Tensor x = torch::pixel_unshuffle(images, 2).to(type).contiguous(layout);
  for (int i = 0; i < kStages; ++i) {
    x = torch::conv2d(x, weight[i].to(type).contiguous(layout), {}, 1, 1);
    if (i + 1 < kStages) x = torch::max_pool2d(x, 2);
    x = torch::batch_norm(x, gain_[i], offset[i], mean[i], variance[i], is_training(), kMomentum, kEpsilon,
                          false);
    x = torch::relu(x);
  }
  return torch::avg_pool2d(x, 2).to(torch::kFloat).contiguous().flatten(1);
}

CnnImpl::CnnImpl() {
  backbone = register_module("backbone", Backbone());
  dense1 = register_module("dense1", torch::nn::Linear(shape::kFlat, shape::kDense1));
  dense2 = register_module("dense2", torch::nn::Linear(shape::kDense1, shape::kDense2));
  output = register_module("output", torch::nn::Linear(shape::kDense2, shape::kOutput));
  // Hypotheses that start apart specialise sooner.
  torch::NoGradGuard guard;
  output->bias.slice(0, 0, shape::kColumns).normal_(0.0, 0.7);
}

CnnOutput CnnImpl::forward(const torch::Tensor& images, bool fast) {
  const torch::Tensor x = torch::relu(dense1(backbone(images, fast)));
  CnnOutput result;
  result.dense2 = torch::relu(dense2(x));
  result.output = output(result.dense2);
  return result;
}

torch::Tensor orthonormal_columns(const torch::Tensor& output) {
  auto sizes = output.sizes().vec();
  sizes.back() = shape::kHypotheses;
  sizes.insert(sizes.end(), {2, 3});
  const torch::Tensor six = output.narrow(-1, 0, shape::kColumns).reshape(sizes);
  const auto normalised = [](const torch::Tensor& v) {
    return v / v.square().sum(-1, true).clamp_min(1e-12).sqrt();
  };
  const torch::Tensor x1 = normalised(six.select(-2, 0));
  const torch::Tensor b = six.select(-2, 1);
  const torch::Tensor x2 = normalised(b - (x1 * b).sum(-1, true) * x1);
  return torch::stack({x1, x2}, -2);
}

torch::Tensor lstm_input(const torch::Tensor& dense2, const torch::Tensor& output) {
  const torch::Tensor columns = orthonormal_columns(output).flatten(-3);
  const torch::Tensor probabilities =
      torch::softmax(output.narrow(-1, shape::kColumns, shape::kHypotheses), -1);
  return torch::cat({dense2, columns, probabilities}, -1);
}

RecurrentImpl::RecurrentImpl() {
  lstm = register_module(
      "lstm", torch::nn::LSTM(torch::nn::LSTMOptions(shape::kLstmInput, shape::kLstm).batch_first(true)));
  head1 = register_module("head1", torch::nn::Linear(shape::kLstm + shape::kLstmInput, shape::kHead));
  head2 = register_module("head2", torch::nn::Linear(shape::kHead, shape::kOutput));
  input_mean = register_buffer("input_mean", torch::zeros({shape::kLstmInput}));
  input_deviation = register_buffer("input_deviation", torch::ones({shape::kLstmInput}));
  torch::NoGradGuard guard;
  head2->weight.mul_(0.1);  // starts near the single-frame estimate
  head2->bias.zero_();
}

void RecurrentImpl::set_standardisation(const torch::Tensor& mean, const torch::Tensor& deviation) {
  torch::NoGradGuard guard;
  input_mean.copy_(mean);
  input_deviation.copy_(deviation.clamp_min(1e-3));
}

torch::Tensor RecurrentImpl::forward(const torch::Tensor& dense2, const torch::Tensor& single_frame_output) {
  const torch::Tensor x = (lstm_input(dense2, single_frame_output) - input_mean) / input_deviation;
  const torch::Tensor h = std::get<0>(lstm(x));
  const torch::Tensor correction = head2(torch::relu(head1(torch::cat({h, x}, -1))));
  const torch::Tensor columns = orthonormal_columns(single_frame_output).flatten(-3);
  const torch::Tensor rest = single_frame_output.narrow(-1, shape::kColumns, shape::kHypotheses + 1);
  return torch::cat({columns, rest}, -1) + correction;
}

}  // namespace tumblesight::sim
