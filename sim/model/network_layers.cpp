#include "sim/model/network_layers.hpp"

#include <iterator>
#include <stdexcept>
#include <string_view>

namespace tumblesight::sim {
namespace {

using gnc::LayerRow;

std::vector<LayerRow> rows(int first, int end) {
  return {std::begin(gnc::kLayers) + first, std::begin(gnc::kLayers) + end};
}

template <class Tensor>
TensorView view_of(const Tensor& tensor) {
  return {tensor.data(), tensor.size()};
}

}  // namespace

std::vector<LayerRow> image_rows() {
  return rows(0, gnc::kImageLayerCount);
}

std::vector<LayerRow> vector_rows() {
  return rows(gnc::kImageLayerCount, gnc::kLstmLayer);
}

std::vector<LayerRow> head_rows() {
  return rows(gnc::kLstmLayer + 1, gnc::kLayerCount);
}

int channels_of(const std::string& name) {
  if (name == gnc::kDepthInput) return gnc::shape::kSpaceToDepthChannels;
  if (name == gnc::kLstmInput) return gnc::shape::kLstmInput;
  const int index = gnc::layer_index(name.c_str());
  if (index == gnc::kLayerCount) throw std::invalid_argument("the network has no layer named " + name);
  return gnc::kLayers[index].outputs;
}

bool is_hidden(const LayerRow& row) {
  return row.output != gnc::LayerOutput::kOutput;
}

bool reads_flat_image(const LayerRow& row) {
  if (is_image_layer(row)) return false;
  const int before = gnc::layer_index(row.reads[0]);
  return before < gnc::kLayerCount && is_image_layer(gnc::kLayers[before]);
}

std::vector<std::string> reads_of(const LayerRow& row) {
  std::vector<std::string> names;
  for (const char* name : row.reads) {
    if (name != nullptr) names.emplace_back(name);
  }
  return names;
}

std::vector<Float32Layer> layers_of(const gnc::NetworkWeights<gnc::Float32>& weights) {
  std::vector<Float32Layer> layers;
  gnc::for_each_layer(weights, [&layers](const LayerRow& row, const auto& layer) {
    Float32Layer& added = layers.emplace_back();
    added.row = row;
    gnc::for_each_tensor_of(layer, [&added](std::string_view part, const auto& tensor) {
      TensorView& view = part == "weight" ? added.weight : part == "bias" ? added.bias : added.recurrent;
      view = view_of(tensor);
    });
  });
  return layers;
}

}  // namespace tumblesight::sim
