#include "sim/training/rcnn_module.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gnc/rcnn/network_shape.hpp"
#include "sim/training/track_module.hpp"

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
  return rotation_from_columns(six.select(-2, 0), six.select(-2, 1)).narrow(-1, 0, 2).transpose(-1, -2);
}

RecurrentImpl::RecurrentImpl(const gnc::Inertia<float>& inertia) : inertia_(inertia) {
  lstm = register_module("lstm", torch::nn::LSTMCell(shape::kLstmInput, shape::kLstm));
  head1 = register_module("head1", torch::nn::Linear(shape::kLstm + shape::kLstmInput, shape::kHead));
  head2 = register_module("head2", torch::nn::Linear(shape::kHead, shape::kHeadOutput));
  input_mean = register_buffer("input_mean", torch::zeros({shape::kLstmInput}));
  input_deviation = register_buffer("input_deviation", torch::ones({shape::kLstmInput}));
  torch::NoGradGuard guard;
  head2->weight.mul_(0.1);  // starts near the filter for smooth rotation
  head2->bias.zero_();
}

void RecurrentImpl::set_standardisation(const torch::Tensor& mean, const torch::Tensor& deviation) {
  torch::NoGradGuard guard;
  input_mean.copy_(mean);
  input_deviation.copy_(deviation.clamp_min(1e-2));
}

TrackedSequences RecurrentImpl::forward(const SequenceHypotheses& sequences) {
  const std::int64_t count = sequences.features.size(0);
  const torch::Tensor nothing = torch::zeros({count, shape::kLstm}, sequences.features.options());
  torch::Tensor h = nothing, c = nothing;
  TrackModule track(inertia_);
  std::vector<torch::Tensor> inputs, answers, means, anchors, errors;
  for (std::int64_t k = 0; k < sequences.features.size(1); ++k) {
    const FrameHypotheses frame(sequences.features.select(1, k), sequences.r_lrf_trf.select(1, k),
                                sequences.logits.select(1, k));
    track.predict(frame);
    const torch::Tensor input = track.lstm_input(frame);
    const torch::Tensor x = (input - input_mean) / input_deviation;
    std::tie(h, c) = lstm(x, std::make_tuple(h, c));
    const Fusion fusion = track.advance(frame, head2(torch::relu(head1(torch::cat({h, x}, -1)))));
    inputs.push_back(input.detach());
    answers.push_back(fusion.r_lrf_trf);
    means.push_back(fusion.cluster_means);
    anchors.push_back(fusion.anchor_logits);
    errors.push_back(fusion.error_logit);
  }
  return {torch::stack(answers, 1), torch::stack(means, 1), torch::stack(anchors, 1), torch::stack(errors, 1),
          torch::stack(inputs, 1)};
}

}  // namespace tumblesight::sim
