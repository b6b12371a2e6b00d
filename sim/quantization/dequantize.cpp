#include "sim/quantization/dequantize.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sim/model/network_layers.hpp"
#include "sim/quantization/input_units.hpp"

namespace tumblesight::sim {

using gnc::FixedPoint;
using gnc::Float32;
namespace {

// Median L2 norm of the channels' weights in near_shoemaker.float32.tsm; dense1 and dense2: of the channels
// that are ever above zero. These norms give the features their size, and with it the weights of cnn_out and
// lstm, which have no free scale: with He's norm in all layers those of cnn_out were 50 times too large.
struct TypicalNorm {
  std::string_view layer;
  double norm;
};
constexpr TypicalNorm kTypicalNorms[] = {{"conv1", 5.0},  {"conv2", 1.6},  {"conv3", 1.6}, {"conv4", 1.6},
                                         {"dense1", 9.0}, {"dense2", 2.0}, {"head1", 6.0}};
constexpr double kHeNorm = 1.4142135623730951;  // with which a layer behind ReLU starts (He et al. 2015)

double typical_norm(std::string_view layer) {
  for (const TypicalNorm& row : kTypicalNorms) {
    if (row.layer == layer) return row.norm;
  }
  return kHeNorm;
}

// [input][channel], of the inputs of one sum.
struct IntegerRows {
  std::size_t channels;
  std::vector<std::int8_t> values;
  double at(std::size_t input, std::size_t channel) const { return values[input * channels + channel]; }
};

// Appends a tensor in the kernels' layout (gnc/nn/kernels/product.hpp).
template <std::size_t kCount>
void append(const FixedPoint::Weights<kCount>& weights, std::size_t padded_channels, std::size_t group,
            IntegerRows& to) {
  for (std::size_t i = 0; i < kCount / padded_channels; ++i) {
    for (std::size_t c = 0; c < to.channels; ++c)
      to.values.push_back(weights.data()[(i / group * padded_channels + c) * group + i % group]);
  }
}

class Dequantizer {
 public:
  Dequantizer(const gnc::NetworkWeights<FixedPoint>& from, DequantizedNetwork& to) : from_(from), to_(to) {}

  void run() {
    put_depth_scales(to_.scales);
    gnc::for_each_index<0, gnc::kLayerCount>([this](auto index) {
      constexpr int kIndex = decltype(index)::value;
      if (kIndex == gnc::kLstmLayer) put_lstm_scales(gnc::kLayers[kIndex], to_.scales);
      layer<kIndex>();
    });
  }

 private:
  template <int kIndex>
  void layer() {
    constexpr gnc::LayerRow kRow = gnc::kLayers[kIndex];
    constexpr std::size_t kGroup = gnc::Layer<FixedPoint, kIndex>::Product::kGroup;
    const auto& from = gnc::layer_weights<kIndex>(from_);
    auto& to = gnc::layer_weights<kIndex>(to_.weights);
    using Weights = std::remove_reference_t<decltype(to)>;

    IntegerRows integers{to.bias.size(), {}};
    append(from.weight, from.bias.size(), kGroup, integers);
    if constexpr (gnc::HasRecurrent<Weights>::value)
      append(from.recurrent, from.bias.size(), kGroup, integers);
    const std::vector<double> inputs = input_units(kRow, to_.scales);
    const std::vector<double> sums = sum_units(kRow, integers, inputs, from);

    std::vector<float> values;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      for (std::size_t c = 0; c < integers.channels; ++c)
        values.push_back(static_cast<float>(integers.at(i, c) * sums[c] / inputs[i]));
    }
    std::copy_n(values.begin(), to.weight.size(), to.weight.begin());
    if constexpr (gnc::HasRecurrent<Weights>::value)
      std::copy_n(values.begin() + to.weight.size(), to.recurrent.size(), to.recurrent.begin());
    for (std::size_t c = 0; c < integers.channels; ++c)
      to.bias[c] = static_cast<float>(from.bias[c] * sums[c]);
  }

  // The unit of each channel's sum. Sets the scales of the layer's outputs where the unit is free.
  template <class Weights>
  std::vector<double> sum_units(const gnc::LayerRow& row, const IntegerRows& integers,
                                const std::vector<double>& inputs, const Weights& from) {
    const bool is_real = !is_hidden(row) || sums_of(row.kind).become_real;
    // The sum of a window stands for its mean.
    const double per_output = row.output == gnc::LayerOutput::kAveragePooled ? 4.0 : 1.0;
    std::vector<double> units;
    for (std::size_t c = 0; c < integers.channels; ++c) {
      units.push_back(is_real ? std::ldexp(1.0, -from.shift[c])
                              : free_unit(row, integers, c, inputs, from.bias[c]));
      if (!is_real) to_.scales[row.name].push_back(std::ldexp(units.back(), from.shift[c]) / per_output);
    }
    return units;
  }

  // The power of two that brings the norm of the channel's weights nearest to the typical one; without
  // weights that of its bias.
  static double free_unit(const gnc::LayerRow& row, const IntegerRows& integers, std::size_t channel,
                          const std::vector<double>& inputs, std::int32_t bias) {
    double squares = 0.0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double weight = integers.at(i, channel) / inputs[i];
      squares += weight * weight;
    }
    const double norm = squares > 0.0 ? std::sqrt(squares) : std::abs(static_cast<double>(bias));
    return norm > 0.0
               ? std::ldexp(1.0, static_cast<int>(std::lround(std::log2(typical_norm(row.name) / norm))))
               : 1.0;
  }

  const gnc::NetworkWeights<FixedPoint>& from_;
  DequantizedNetwork& to_;
};

}  // namespace

std::unique_ptr<DequantizedNetwork> dequantize(const gnc::NetworkWeights<FixedPoint>& weights) {
  auto network = std::make_unique<DequantizedNetwork>();
  Dequantizer(weights, *network).run();
  return network;
}

std::unique_ptr<Float32Model> dequantized_model(const std::string& path) {
  const std::vector<std::uint8_t> image = read_model_bytes(path);
  if (gnc::is_float32(image.data(), image.size()))
    throw std::runtime_error("model image '" + path + "' is in float32 already; give one in fixed point");
  auto model = std::make_unique<Float32Model>();
  gnc::NetworkWeights<FixedPoint> weights;  // they point into `image`
  const gnc::ModelStatus status =
      gnc::read_model_image<FixedPoint>(image.data(), image.size(), nullptr, model->header, weights);
  if (status != gnc::ModelStatus::kOk)
    throw std::runtime_error("model image '" + path + "' is refused: " + gnc::to_string(status));
  model->header.noise = {};
  model->weights = dequantize(weights)->weights;
  return model;
}

}  // namespace tumblesight::sim
