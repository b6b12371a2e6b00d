#include "sim/training/import_model.hpp"

#include <map>
#include <string>

#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
namespace {

using TensorsByName = std::map<std::string, torch::Tensor>;

TensorsByName tensors_of(const gnc::NetworkWeights<gnc::Float32>& weights) {
  TensorsByName tensors;
  gnc::for_each_tensor(weights, [&](const char* layer, const char* part, const auto& tensor) {
    tensors[std::string(layer) + "." + part] =
        torch::from_blob(const_cast<float*>(tensor.data()), {static_cast<std::int64_t>(tensor.size())},
                         torch::kFloat)
            .clone();
  });
  return tensors;
}

void import_dense(const TensorsByName& tensors, const std::string& layer, torch::nn::Linear& linear) {
  const auto inputs = linear->weight.size(1);
  linear->weight.copy_(tensors.at(layer + ".weight").view({inputs, -1}).t());
  linear->bias.copy_(tensors.at(layer + ".bias"));
}

// The batch norm divides by the deviation, which the image has folded away; the next layer makes up for it.
// Returns the deviations of the last stage.
torch::Tensor import_backbone(const TensorsByName& tensors, const torch::Tensor& images, Backbone& backbone) {
  torch::Tensor x = torch::pixel_unshuffle(images, 2);
  torch::Tensor deviation = torch::ones({shape::kSpaceToDepthChannels});
  for (int i = 0; i < BackboneImpl::kStages; ++i) {
    const std::string layer = "conv" + std::to_string(i + 1);
    const auto out = backbone->weight[i].size(0);
    const torch::Tensor folded = tensors.at(layer + ".weight").view({3, 3, -1, out}).permute({3, 2, 0, 1});
    backbone->weight[i].copy_(folded * deviation.view({1, -1, 1, 1}));
    x = torch::conv2d(x, backbone->weight[i], {}, 1, 1);
    if (i + 1 < BackboneImpl::kStages) x = torch::max_pool2d(x, 2);
    const torch::Tensor mean = x.mean({0, 2, 3});
    const torch::Tensor variance = x.var({0, 2, 3}, false);
    deviation = (variance + BackboneImpl::kEpsilon).sqrt();
    backbone->mean[i].copy_(mean);
    backbone->variance[i].copy_(variance);
    backbone->offset[i].copy_((mean + tensors.at(layer + ".bias")) / deviation);
    x = torch::relu((x + tensors.at(layer + ".bias").view({1, -1, 1, 1})) / deviation.view({1, -1, 1, 1}));
  }
  return deviation;
}

}  // namespace

void import_cnn(const gnc::NetworkWeights<gnc::Float32>& weights, const torch::Tensor& images, Cnn& cnn) {
  torch::NoGradGuard guard;
  const TensorsByName tensors = tensors_of(weights);
  const torch::Tensor deviation = import_backbone(tensors, images, cnn->backbone);
  import_dense(tensors, "dense1", cnn->dense1);
  import_dense(tensors, "dense2", cnn->dense2);
  import_dense(tensors, "cnn_out", cnn->output);
  // The flight network flattens pixel by pixel, LibTorch channel by channel.
  const torch::Tensor by_channel =
      cnn->dense1->weight.view({shape::kDense1, 9, shape::kConv4}).transpose(1, 2) *
      deviation.view({1, -1, 1});
  cnn->dense1->weight.copy_(by_channel.flatten(1));
}

}  // namespace tumblesight::sim
