#include "sim/model/network_layers.hpp"

#include <iterator>
#include <stdexcept>
#include <string_view>

namespace tumblesight::sim {
namespace {

using gnc::LayerKind;
using gnc::LayerRow;

constexpr int kWindow = 3 * 3;  // pixels under a convolution's kernel

template <class Tensor>
TensorView view_of(const Tensor& tensor) {
  return {tensor.data(), tensor.size()};
}

}  // namespace

std::vector<LayerRow> cnn_rows(LayerKind kind) {
  std::vector<LayerRow> rows;
  for (int i = 0; i < gnc::kLstmLayer; ++i) {
    if (gnc::kLayers[i].kind == kind) rows.push_back(gnc::kLayers[i]);
  }
  return rows;
}

std::vector<LayerRow> head_rows() {
  return {std::begin(gnc::kLayers) + gnc::kLstmLayer + 1, std::end(gnc::kLayers)};
}

int channels_of(const std::string& name) {
  if (name == gnc::kDepthInput) return gnc::shape::kSpaceToDepthChannels;
  if (name == gnc::kLstmInput) return gnc::shape::kLstmInput;
  const int index = gnc::layer_index(name.c_str());
  if (index == gnc::kLayerCount) throw std::invalid_argument("the network has no layer named " + name);
  return gnc::kLayers[index].outputs;
}

int inputs_per_sum(const LayerRow& row) {
  if (row.kind == LayerKind::kConvolution) return kWindow * row.inputs;
  return row.kind == LayerKind::kLstm ? row.inputs + row.outputs : row.inputs;
}

bool is_hidden(const LayerRow& row) {
  return row.output != gnc::LayerOutput::kOutput;
}

bool reads_flat_image(const LayerRow& row) {
  if (row.kind == LayerKind::kConvolution) return false;
  const int before = gnc::layer_index(row.reads[0]);
  return before < gnc::kLayerCount && gnc::kLayers[before].kind == LayerKind::kConvolution;
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
