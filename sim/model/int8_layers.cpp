#include "sim/model/int8_layers.hpp"

#include <cmath>

namespace tumblesight::sim {
namespace {

constexpr float kConvUnit = 1.0F;
constexpr float kAveragedUnit = 4096.0F / 256.0F;
constexpr float kDenseUnit = 32768.0F / 256.0F;
constexpr float kPixelsPerWindow = 4.0F;
constexpr float kHiddenStateUnit = 32768.0F;  // counts of 1 in Q0.15

float output_unit(const gnc::LayerRow& row) {
  if (row.output == gnc::LayerOutput::kMaxPooled) return kConvUnit;
  if (row.output == gnc::LayerOutput::kAveragePooled) return kAveragedUnit;
  return row.output == gnc::LayerOutput::kHidden ? kDenseUnit : 1.0F;
}

float input_unit(const gnc::LayerRow& row) {
  const int before = gnc::layer_index(row.reads[0]);
  if (before == gnc::kLayerCount) return kConvUnit;  // the depth image
  const gnc::LayerRow& read = gnc::kLayers[before];
  const float pixels = read.output == gnc::LayerOutput::kAveragePooled ? kPixelsPerWindow : 1.0F;
  return pixels * output_unit(read);
}

// [input][channel], without the channels that are added to fill vectors. `group`: see
// gnc/nn/kernels/product.hpp.
template <class Weights>
std::vector<std::int8_t> ungrouped(const Weights& weights, std::size_t stored, std::size_t channels,
                                   std::size_t group) {
  const std::size_t inputs = weights.size() / stored;
  std::vector<std::int8_t> result;
  for (std::size_t i = 0; i < inputs; ++i) {
    for (std::size_t c = 0; c < channels; ++c)
      result.push_back(weights.data()[(i / group * stored + c) * group + i % group]);
  }
  return result;
}

template <class Layer>
std::vector<std::int8_t> ungrouped_weights(const gnc::LayerRow& row, const Layer& layer) {
  const int group = is_image_layer(row) ? gnc::Int8Product::kGroup : gnc::Int16Product::kGroup;
  return ungrouped(layer.weight, layer.bias.size(), static_cast<std::size_t>(sum_channels(row)),
                   static_cast<std::size_t>(group));
}

template <class Layer>
Int8Layer int8_layer(const gnc::LayerRow& row, const Layer& layer) {
  Int8Layer result{row, ungrouped_weights(row, layer), {}, {}, input_unit(row), output_unit(row)};
  for (std::size_t c = 0; c < static_cast<std::size_t>(row.outputs); ++c) {
    const float bias = static_cast<float>(layer.bias[c]) / result.input_unit;
    result.bias.push_back(result.input_unit == 1.0F ? layer.bias[c]
                                                    : static_cast<std::int32_t>(std::lround(bias)));
    result.scale.push_back(std::ldexp(result.input_unit / result.output_unit, -layer.shift[c]));
  }
  return result;
}

// The sums of a layer, [input][channel] and bias, in the unit of the real output. `counts(i)`: counts per
// unit of input i.
template <class Tensor, class Shifts, class Counts>
void put_weights(const std::vector<std::int8_t>& from, const Shifts& shift, std::size_t channels,
                 const Counts& counts, Tensor& to) {
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] = std::ldexp(counts(i / channels) * static_cast<float>(from[i]), -shift[i % channels]);
}

template <class From, class To>
void put_layer(const gnc::LayerRow& row, const From& from, To& to) {
  const bool reads_hidden_state = gnc::is_same_name(row.reads[0], gnc::kLayers[gnc::kLstmLayer].name);
  const auto channels = static_cast<std::size_t>(sum_channels(row));
  put_weights(
      ungrouped_weights(row, from), from.shift, channels,
      [&](std::size_t i) { return reads_hidden_state && i < gnc::shape::kLstm ? kHiddenStateUnit : 1.0F; },
      to.weight);
  if constexpr (gnc::HasRecurrent<To>::value) {
    put_weights(
        ungrouped(from.recurrent, channels, channels, gnc::Int16Product::kGroup), from.shift, channels,
        [](std::size_t) { return kHiddenStateUnit; }, to.recurrent);
  }
  for (std::size_t c = 0; c < channels; ++c)
    to.bias[c] = std::ldexp(static_cast<float>(from.bias[c]), -from.shift[c]);
}

}  // namespace

std::vector<Int8Layer> int8_layers_of(const gnc::NetworkWeights<gnc::FixedPoint>& weights) {
  std::vector<Int8Layer> layers;
  gnc::for_each_layer(weights, [&layers](const gnc::LayerRow& row, const auto& layer) {
    if (gnc::layer_index(row.name) < gnc::kLstmLayer) layers.push_back(int8_layer(row, layer));
  });
  return layers;
}

std::unique_ptr<Float32Model> recurrent_in_float32(const gnc::ModelHeader& header,
                                                   const gnc::NetworkWeights<gnc::FixedPoint>& weights) {
  auto model = std::make_unique<Float32Model>();
  model->header = header;
  gnc::for_each_index<gnc::kLstmLayer, gnc::kLayerCount>([&](auto index) {
    constexpr int kIndex = decltype(index)::value;
    put_layer(gnc::kLayers[kIndex], gnc::layer_weights<kIndex>(weights),
              gnc::layer_weights<kIndex>(model->weights));
  });
  return model;
}

}  // namespace tumblesight::sim
