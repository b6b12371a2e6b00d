#include "sim/training/export_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

using TensorsByName = std::map<std::string, torch::Tensor>;

void add(TensorsByName& tensors, const std::string& name, const torch::Tensor& tensor) {
  tensors[name] = tensor.detach().to(torch::kCPU, torch::kFloat).contiguous();
}

// [out, in, 3, 3] with the norm that follows -> [3][3][in][out] and a bias.
void add_convolutions(TensorsByName& tensors, const Backbone& backbone) {
  for (int i = 0; i < BackboneImpl::kStages; ++i) {
    const std::string layer = "conv" + std::to_string(i + 1);
    const torch::Tensor scale = (backbone->variance[i] + BackboneImpl::kEpsilon).rsqrt();
    add(tensors, layer + ".weight", (backbone->weight[i] * scale.view({-1, 1, 1, 1})).permute({2, 3, 1, 0}));
    add(tensors, layer + ".bias", backbone->offset[i] - backbone->mean[i] * scale);
  }
}

void add_dense(TensorsByName& tensors, const std::string& layer, const torch::Tensor& weight,
               const torch::Tensor& bias) {
  add(tensors, layer + ".weight", weight.t());
  add(tensors, layer + ".bias", bias);
}

void add_cnn(TensorsByName& tensors, const Cnn& cnn) {
  add_convolutions(tensors, cnn->backbone);
  // LibTorch flattens channel by channel, the flight network pixel by pixel.
  const torch::Tensor dense1 =
      cnn->dense1->weight.view({shape::kDense1, shape::kConv4, 9}).transpose(1, 2).flatten(1);
  add_dense(tensors, "dense1", dense1, cnn->dense1->bias);
  add_dense(tensors, "dense2", cnn->dense2->weight, cnn->dense2->bias);
  add_dense(tensors, "cnn_out", cnn->output->weight, cnn->output->bias);
}

// W (x - mean) / deviation + b = (W / deviation) x + (b - (W / deviation) mean)
void add_recurrent(TensorsByName& tensors, const Recurrent& recurrent) {
  const auto parameters = recurrent->lstm->named_parameters();
  const torch::Tensor input = parameters["weight_ih"] / recurrent->input_deviation;
  add(tensors, "lstm.weight", input.t());
  add(tensors, "lstm.recurrent", parameters["weight_hh"].t());
  add(tensors, "lstm.bias",
      parameters["bias_ih"] + parameters["bias_hh"] - torch::matmul(input, recurrent->input_mean));

  const torch::Tensor hidden = recurrent->head1->weight.narrow(1, 0, shape::kLstm);
  const torch::Tensor direct =
      recurrent->head1->weight.narrow(1, shape::kLstm, shape::kLstmInput) / recurrent->input_deviation;
  add_dense(tensors, "head1", torch::cat({hidden, direct}, 1),
            recurrent->head1->bias - torch::matmul(direct, recurrent->input_mean));
  add_dense(tensors, "head2", recurrent->head2->weight, recurrent->head2->bias);
}

}  // namespace

void export_weights(const Cnn& cnn, const Recurrent& recurrent, gnc::NetworkWeights<gnc::Float32>& weights) {
  torch::NoGradGuard guard;
  TensorsByName tensors;
  add_cnn(tensors, cnn);
  add_recurrent(tensors, recurrent);
  gnc::for_each_tensor(weights, [&](const char* layer, const char* part, auto& tensor) {
    const std::string name = std::string(layer) + "." + part;
    const auto found = tensors.find(name);
    if (found == tensors.end() || found->second.numel() != static_cast<std::int64_t>(tensor.size())) {
      throw std::logic_error("the trainer has no tensor of this size for " + name);
    }
    std::copy_n(found->second.data_ptr<float>(), tensor.size(), tensor.data());
  });
}

void shorten(gnc::NetworkWeights<gnc::Float32>& weights) {
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
    throw std::runtime_error("target name '" + target + "' must be printable and at most " +
                             std::to_string(header.target.size() - 1) + " characters long");
  }
  header.projection = targets.projection;
  const gnc::Matrix3<gnc::Fixed> tensor_trf = gnc::converted<gnc::Fixed>(targets.inertia.tensor_trf);
  if (!gnc::make_inertia<gnc::Fixed>(tensor_trf, header.inertia)) {
    throw std::runtime_error("the inertia of '" + target + "' is too near to a thin rod's");
  }
  return header;
}

}  // namespace tumblesight::sim
