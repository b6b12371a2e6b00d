#include "sim/training/export_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {

torch::Tensor tensor_of(const TensorView& values) {
  return torch::from_blob(const_cast<float*>(values.data), {static_cast<std::int64_t>(values.size)},
                          torch::kFloat);
}

torch::Tensor weight_from_flight(const gnc::LayerRow& row, const torch::Tensor& flat) {
  const int sums = sum_channels(row);
  if (is_image_layer(row)) {
    const int window = sums_of(row.kind).window;
    return flat.view({window, window, row.inputs, sums}).permute({3, 2, 0, 1});
  }
  if (reads_flat_image(row)) {
    return flat.view({-1, channels_of(row.reads[0]), sums}).permute({2, 1, 0}).flatten(1);
  }
  return flat.view({-1, sums}).t();
}

torch::Tensor weight_to_flight(const gnc::LayerRow& row, const torch::Tensor& weight) {
  if (is_image_layer(row)) return weight.permute({2, 3, 1, 0});
  if (reads_flat_image(row)) {
    return weight.view({sum_channels(row), channels_of(row.reads[0]), -1}).permute({2, 1, 0});
  }
  return weight.t();
}

namespace shape = gnc::shape;
namespace {

// By <layer>.<part>, in the flight network's layout.
class FlightTensors {
 public:
  void add(const std::string& name, const torch::Tensor& tensor) {
    tensors_[name] = tensor.detach().to(torch::kCPU, torch::kFloat).contiguous();
  }

  // `weight` in LibTorch's layout.
  void add_layer(const gnc::LayerRow& row, const torch::Tensor& weight, const torch::Tensor& bias) {
    add(std::string(row.name) + ".weight", weight_to_flight(row, weight));
    add(std::string(row.name) + ".bias", bias);
  }

  void copy_to(gnc::NetworkWeights<gnc::Float32>& weights) const {
    gnc::for_each_tensor(weights, [&](const char* layer, const char* part, auto& tensor) {
      const std::string name = std::string(layer) + "." + part;
      const auto found = tensors_.find(name);
      if (found == tensors_.end() || found->second.numel() != static_cast<std::int64_t>(tensor.size())) {
        throw std::logic_error("the trainer has no tensor of this size for " + name);
      }
      std::copy_n(found->second.data_ptr<float>(), tensor.size(), tensor.data());
    });
  }

 private:
  std::map<std::string, torch::Tensor> tensors_;
};

struct WeightAndBias {
  torch::Tensor weight, bias;
};

// The batch norm behind a convolution becomes part of it.
WeightAndBias with_batch_norm(const Backbone& backbone, int stage) {
  const torch::Tensor scale = (backbone->variance[stage] + BackboneImpl::kEpsilon).rsqrt();
  return {backbone->weight[stage] * scale.view({-1, 1, 1, 1}),
          backbone->offset[stage] - backbone->mean[stage] * scale};
}

// The standardization of the LSTM input becomes part of a layer that reads it from input `first` on:
// W (x - mean) / deviation + b = (W / deviation) x + (b - (W / deviation) mean)
WeightAndBias with_standardisation(const Recurrent& recurrent, const torch::Tensor& weight,
                                   const torch::Tensor& bias, std::int64_t first) {
  const torch::Tensor scaled = weight.narrow(1, first, shape::kLstmInput) / recurrent->input_deviation;
  return {torch::cat({weight.narrow(1, 0, first), scaled}, 1),
          bias - torch::matmul(scaled, recurrent->input_mean)};
}

void add_cnn(FlightTensors& tensors, const Cnn& cnn) {
  int index = 0;
  for (const gnc::LayerRow& row : image_rows()) {
    const WeightAndBias layer = with_batch_norm(cnn->backbone, index++);
    tensors.add_layer(row, layer.weight, layer.bias);
  }
  index = 0;
  for (const gnc::LayerRow& row : vector_rows()) {
    const torch::nn::Linear& layer = cnn->dense[index++];
    tensors.add_layer(row, layer->weight, layer->bias);
  }
}

void add_recurrent(FlightTensors& tensors, const Recurrent& recurrent) {
  const gnc::LayerRow& row = gnc::kLayers[gnc::kLstmLayer];
  const auto parameters = recurrent->lstm->named_parameters();
  const WeightAndBias lstm = with_standardisation(recurrent, parameters["weight_ih"],
                                                  parameters["bias_ih"] + parameters["bias_hh"], 0);
  tensors.add_layer(row, lstm.weight, lstm.bias);
  tensors.add(std::string(row.name) + ".recurrent", weight_to_flight(row, parameters["weight_hh"]));

  std::size_t index = 0;
  for (const gnc::LayerRow& head : head_rows()) {
    const torch::nn::Linear& layer = recurrent->head[index++];
    const std::vector<std::string> reads = reads_of(head);
    const bool standardised = reads.back() == gnc::kLstmInput;
    const WeightAndBias folded = standardised ? with_standardisation(recurrent, layer->weight, layer->bias,
                                                                     head.inputs - shape::kLstmInput)
                                              : WeightAndBias{layer->weight, layer->bias};
    tensors.add_layer(head, folded.weight, folded.bias);
  }
}

}  // namespace

void export_weights(const Cnn& cnn, const Recurrent& recurrent, gnc::NetworkWeights<gnc::Float32>& weights) {
  torch::NoGradGuard guard;
  FlightTensors tensors;
  add_cnn(tensors, cnn);
  add_recurrent(tensors, recurrent);
  tensors.copy_to(weights);
}

void round_to_10_bits(gnc::NetworkWeights<gnc::Float32>& weights) {
  gnc::for_each_tensor(weights, [](const char*, const char*, auto& tensor) {
    for (float& value : tensor) {
      int exponent = 0;
      const float mantissa = std::frexp(value, &exponent);
      value = std::ldexp(std::nearbyint(mantissa * 1024.0F), exponent - 10);
    }
  });
}

gnc::ModelHeader model_header(const std::string& target, const TrainingTargets& targets) {
  gnc::ModelHeader header;
  if (!gnc::set_target(header, target.c_str())) {
    throw std::runtime_error("target name '" + target + "' must be printable ASCII of 1 to " +
                             std::to_string(header.target.size() - 1) + " characters");
  }
  header.projection = targets.projection;
  header.mission_crc32 = targets.mission_crc32;
  const gnc::Matrix3<gnc::Fixed> tensor_trf = gnc::converted<gnc::Fixed>(targets.inertia.tensor_trf);
  if (!gnc::make_inertia<gnc::Fixed>(tensor_trf, header.inertia)) {
    throw std::runtime_error("the inertia of '" + target +
                             "' is too close to that of a thin rod: no principal moment may be near zero");
  }
  return header;
}

void make_neutral(Recurrent& recurrent, double mean_error_rad) {
  torch::NoGradGuard guard;
  torch::nn::Linear& last = recurrent->head.back();
  last->weight.zero_();
  last->bias.zero_();
  const double share = std::clamp(mean_error_rad / kPi, 1e-3, 0.9);
  last->bias[shape::kHeadOutput - 1] = std::log(share / (1.0 - share));
}

std::unique_ptr<Float32Model> model_of(const Cnn& cnn, const Recurrent& recurrent, const std::string& target,
                                       const TrainingTargets& targets) {
  auto model = std::make_unique<Float32Model>();
  model->header = model_header(target, targets);
  export_weights(cnn, recurrent, model->weights);
  round_to_10_bits(model->weights);
  return model;
}

}  // namespace tumblesight::sim
