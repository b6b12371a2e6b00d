#include "sim/training/rcnn_module.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/model/network_layers.hpp"
#include "sim/training/track_module.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;

namespace {

constexpr double kMomentum = 0.05;

constexpr bool has_only_convolutions() {
  for (int i = 0; i < BackboneImpl::kStages; ++i) {
    if (gnc::kLayers[i].kind != gnc::LayerKind::kConvolution) return false;
  }
  return true;
}
static_assert(has_only_convolutions(), "the backbone consists of convolutions");

// The sums of a layer of the CNN or of the head that reads vectors.
torch::nn::Linear linear_of(const gnc::LayerRow& row) {
  return torch::nn::Linear(row.inputs, sum_channels(row));
}

// The layer's output from its sums.
torch::Tensor output_of(const gnc::LayerRow& row, const torch::Tensor& sums) {
  switch (row.kind) {
    case gnc::LayerKind::kDense:
      return is_hidden(row) ? torch::relu(sums) : sums;
    case gnc::LayerKind::kConvolution:
    case gnc::LayerKind::kLstm:
      break;  // modules of their own
  }
  throw std::logic_error(std::string("layer ") + row.name + " does not stand in the backbone or as the LSTM");
}

// In the checkpoints the single-frame head has a name of its own.
std::string module_name(const gnc::LayerRow& row) {
  return is_hidden(row) ? row.name : "output";
}

}  // namespace

BackboneImpl::BackboneImpl() {
  int i = 0;
  for (const gnc::LayerRow& row : image_rows()) {
    const std::string stage = std::to_string(i + 1);
    const double he = std::sqrt(2.0 / (9.0 * row.inputs));
    weight[i] = register_parameter("weight" + stage, torch::randn({row.outputs, row.inputs, 3, 3}) * he);
    offset[i] = register_parameter("offset" + stage, torch::zeros({row.outputs}));
    mean[i] = register_buffer("mean" + stage, torch::zeros({row.outputs}));
    variance[i] = register_buffer("variance" + stage, torch::ones({row.outputs}));
    gain_[i] = register_buffer("gain" + stage, torch::ones({row.outputs}));
    ++i;
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
  for (const gnc::LayerRow& row : vector_rows())
    dense.push_back(register_module(module_name(row), linear_of(row)));
  // Hypotheses that start apart specialize sooner.
  torch::NoGradGuard guard;
  dense.back()->bias.slice(0, 0, shape::kColumns).normal_(0.0, 0.7);
}

CnnOutput CnnImpl::forward(const torch::Tensor& images, bool fast) {
  CnnOutput result;
  result.output = backbone(images, fast);
  for (int i = gnc::kImageLayerCount; i < gnc::kLstmLayer; ++i) {
    result.output = output_of(gnc::kLayers[i], dense[i - gnc::kImageLayerCount](result.output));
    if (i == gnc::kFeatureLayer) result.features = result.output;
  }
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
  for (const gnc::LayerRow& row : head_rows()) head.push_back(register_module(row.name, linear_of(row)));
  input_mean = register_buffer("input_mean", torch::zeros({shape::kLstmInput}));
  input_deviation = register_buffer("input_deviation", torch::ones({shape::kLstmInput}));
  torch::NoGradGuard guard;
  head.back()->weight.mul_(0.1);  // starts near the filter for smooth rotation
  head.back()->bias.zero_();
}

void RecurrentImpl::set_standardisation(const torch::Tensor& mean, const torch::Tensor& deviation) {
  torch::NoGradGuard guard;
  input_mean.copy_(mean);
  input_deviation.copy_(deviation.clamp_min(1e-2));
}

torch::Tensor RecurrentImpl::head_output(torch::Tensor x) {
  for (std::size_t i = 0; i < head.size(); ++i) {
    x = output_of(gnc::kLayers[gnc::kLstmLayer + 1 + static_cast<int>(i)], head[i](x));
  }
  return x;
}

TrackedSequences RecurrentImpl::forward(const SequenceHypotheses& sequences) {
  const std::int64_t count = sequences.features.size(0);
  const torch::Tensor nothing = torch::zeros({count, shape::kLstm}, sequences.features.options());
  torch::Tensor h = nothing, c = nothing;
  TrackModule track(inertia_);
  std::vector<torch::Tensor> inputs, answers, means, anchors, errors;
  for (std::int64_t k = 0; k < sequences.features.size(1); ++k) {
    const FrameHypotheses frame(sequences.features.select(1, k), sequences.r_lrf_trf.select(1, k),
                                sequences.logits.select(1, k), sequences.periods.select(1, k));
    track.predict(frame);
    const torch::Tensor input = track.lstm_input(frame);
    const torch::Tensor x = (input - input_mean) / input_deviation;
    std::tie(h, c) = lstm(x, std::make_tuple(h, c));
    const Fusion fusion = track.advance(frame, head_output(torch::cat({h, x}, -1)));
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
