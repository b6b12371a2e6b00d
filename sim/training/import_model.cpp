#include "sim/training/import_model.hpp"

#include <vector>

#include "sim/training/export_model.hpp"

namespace tumblesight::sim {
namespace {

// One convolution with the batch norm behind it. The norm divides by the deviation of its input, which the
// image's weights do not contain; the next layer's weights compensate for this. On entry `x` is the layer's
// input and `deviation` the deviation of each of its channels; on return both are those of the layer's
// output.
void import_stage(const Float32Layer& layer, int stage, bool pooled, Backbone& backbone, torch::Tensor& x,
                  torch::Tensor& deviation) {
  const torch::Tensor bias = tensor_of(layer.bias);
  const torch::Tensor weight = weight_from_flight(layer.row, tensor_of(layer.weight));
  backbone->weight[stage].copy_(weight * deviation.view({1, -1, 1, 1}));
  x = torch::conv2d(x, backbone->weight[stage], {}, 1, 1);
  if (pooled) x = torch::max_pool2d(x, 2);
  const torch::Tensor mean = x.mean({0, 2, 3});
  const torch::Tensor variance = x.var({0, 2, 3}, false);
  deviation = (variance + BackboneImpl::kEpsilon).sqrt();
  backbone->mean[stage].copy_(mean);
  backbone->variance[stage].copy_(variance);
  backbone->offset[stage].copy_((mean + bias) / deviation);
  x = torch::relu((x + bias.view({1, -1, 1, 1})) / deviation.view({1, -1, 1, 1}));
}

}  // namespace

void import_cnn(const gnc::NetworkWeights<gnc::Float32>& weights, const torch::Tensor& images, Cnn& cnn) {
  torch::NoGradGuard guard;
  torch::Tensor x = torch::pixel_unshuffle(images, 2);
  torch::Tensor deviation = torch::ones({gnc::shape::kSpaceToDepthChannels});
  int stage = 0;
  std::size_t dense = 0;
  const std::vector<Float32Layer> layers = layers_of(weights);
  for (int i = 0; i < gnc::kLstmLayer; ++i) {
    const Float32Layer& layer = layers[i];
    if (is_image_layer(layer.row)) {
      const bool pooled = layer.row.output == gnc::LayerOutput::kMaxPooled;
      import_stage(layer, stage++, pooled, cnn->backbone, x, deviation);
      continue;
    }
    torch::nn::Linear& linear = cnn->dense[dense++];
    torch::Tensor weight = weight_from_flight(layer.row, tensor_of(layer.weight));
    if (reads_flat_image(layer.row)) {  // compensates for the last norm, channel by channel
      weight = (weight.view({sum_channels(layer.row), deviation.size(0), -1}) * deviation.view({1, -1, 1}))
                   .flatten(1);
    }
    linear->weight.copy_(weight);
    linear->bias.copy_(tensor_of(layer.bias));
  }
}

}  // namespace tumblesight::sim
