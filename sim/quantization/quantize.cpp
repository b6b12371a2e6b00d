#include "sim/quantization/quantize.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "sim/model/network_layers.hpp"
#include "sim/quantization/input_units.hpp"
#include "sim/quantization/scales.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
using gnc::FixedPoint;
using gnc::Float32;
namespace {

// Half the range: frames other than those of the calibration may exceed its largest value.
constexpr double kLargestInt16 = 32767.0 / 2.0;

std::int32_t to_integer(double value) {
  return static_cast<std::int32_t>(std::lround(std::min(2147483647.0, std::max(-2147483647.0, value))));
}

// Weights of the inputs [first, first + count), in the kernels' layout (gnc/nn/kernels/product.hpp).
template <std::size_t kCount>
void put_weights(const IntegerLayer& layer, std::size_t first, std::size_t count, std::size_t padded_channels,
                 std::size_t group, QuantizedNetwork& network, FixedPoint::Weights<kCount>& weights) {
  std::vector<std::int8_t>& bytes = network.storage.emplace_back(kCount, std::int8_t{0});
  for (std::size_t i = 0; i < count; ++i) {
    for (Eigen::Index c = 0; c < layer.weight.cols(); ++c) {
      bytes.at((i / group * padded_channels + static_cast<std::size_t>(c)) * group + i % group) =
          static_cast<std::int8_t>(layer.weight(static_cast<Eigen::Index>(first + i), c));
    }
  }
  weights.set_data(bytes.data());
}

template <class Weights>
void put_bias(const FloatLayer& layer, const std::vector<double>& scales, const IntegerLayer& integers,
              Weights& weights) {
  weights.bias.fill(0);
  weights.shift.fill(1);
  for (int c = 0; c < layer.channels; ++c) {
    weights.bias[c] = to_integer(layer.bias[c] / scales[c] + integers.mean_loss[c]);
  }
}

// Shifts from the sum, whose unit is a power of two, to Q7.24.
template <class Weights>
void put_output_shifts(const FloatLayer& layer, const std::vector<double>& scales, Weights& weights) {
  for (int c = 0; c < layer.channels; ++c) {
    const double shift = -std::log2(scales[c]);
    if (shift < 1.0 || shift > 62.0) {
      throw std::runtime_error("layer " + layer.name + ", channel " + std::to_string(c) +
                               ": the largest weight, " + std::to_string(largest_weight(layer, c)) +
                               ", is outside the range of fixed point");
    }
    weights.shift[c] = static_cast<std::uint8_t>(shift);
  }
}

class Quantizer {
 public:
  Quantizer(const gnc::NetworkWeights<Float32>& from, const Statistics& statistics, QuantizedNetwork& to)
      : from_(from), statistics_(statistics), to_(to) {}

  void run() {
    put_depth_scales(to_.scales);
    gnc::for_each_index<0, gnc::kLayerCount>([this](auto index) {
      constexpr int kIndex = decltype(index)::value;
      constexpr gnc::LayerRow kRow = gnc::kLayers[kIndex];
      const auto& from = gnc::layer_weights<kIndex>(from_);
      auto& to = gnc::layer_weights<kIndex>(to_.weights);
      layer(Kind<kRow.kind>(), kRow, from, to);
    });
  }

 private:
  // Per kind of layer. A kind without such a function does not compile.
  template <gnc::LayerKind kKind>
  using Kind = std::integral_constant<gnc::LayerKind, kKind>;

  template <class From, class To>
  void layer(Kind<gnc::LayerKind::kConvolution>, const gnc::LayerRow& row, const From& from, To& to) {
    if (row.output == gnc::LayerOutput::kMaxPooled) {
      max_pooled_convolution(row, from, to);
    } else {
      average_pooled_convolution(row, from, to);
    }
  }
  template <class From, class To>
  void layer(Kind<gnc::LayerKind::kDense>, const gnc::LayerRow& row, const From& from, To& to) {
    if (is_hidden(row)) {
      hidden_dense(row, from, to);
    } else {
      output_dense(row, from, to);
    }
  }
  template <class From, class To>
  void layer(Kind<gnc::LayerKind::kLstm>, const gnc::LayerRow& row, const From& from, To& to) {
    lstm(row, from, to);
  }

  template <class From>
  FloatLayer layer_of(const gnc::LayerRow& row, const From& from) const {
    FloatLayer layer{
        row.name, static_cast<int>(from.bias.size()), {}, input_units(row, to_.scales), from.bias.data()};
    add_rows(layer, from.weight.data(), from.weight.size() / from.bias.size());
    return layer;
  }

  // Outputs have 8 bits.
  template <class From, class To>
  void max_pooled_convolution(const gnc::LayerRow& row, const From& from, To& to) {
    const FloatLayer layer = layer_of(row, from);
    put<gnc::Int8Product::kGroup>(
        layer, scales_of_least_loss(layer, inputs_of(layer), outputs_of(layer), kLargestUint8), to);
  }
  // Outputs are the sums of four integers of 12 bits, so they have bits to spare.
  template <class From, class To>
  void average_pooled_convolution(const gnc::LayerRow& row, const From& from, To& to) {
    const FloatLayer layer = layer_of(row, from);
    // The observed outputs are means of four: one of the four may be as large as their sum.
    put<gnc::Int8Product::kGroup>(
        layer, scales_that_fit(layer, outputs_of(layer), gnc::kMaxAveragedActivation / 4.0), to);
    for (double& scale : to_.scales.at(row.name)) scale /= 4.0;  // the sum of a window stands for its mean
  }
  template <class From, class To>
  void hidden_dense(const gnc::LayerRow& row, const From& from, To& to) {
    const FloatLayer layer = layer_of(row, from);
    put<gnc::Int16Product::kGroup>(layer, scales_that_fit(layer, outputs_of(layer), kLargestInt16), to);
  }

  // Weights, biases and shifts of a layer whose outputs are activations.
  template <std::size_t kGroup, class To>
  void put(const FloatLayer& layer, const OutputScales& scales, To& to) {
    const IntegerLayer integers = integers_of(layer, scales.sum, inputs_of(layer));
    put_weights(integers, 0, layer.rows.size(), to.bias.size(), kGroup, to_, to.weight);
    put_bias(layer, scales.sum, integers, to);
    for (int c = 0; c < layer.channels; ++c) {
      to.shift[c] = static_cast<std::uint8_t>(scales.shift[c]);
      to_.scales[layer.name].push_back(std::ldexp(scales.sum[c], scales.shift[c]));
    }
  }

  template <class From, class To>
  void output_dense(const gnc::LayerRow& row, const From& from, To& to) {
    const FloatLayer layer = layer_of(row, from);
    const std::vector<double> scales = powers_of_two(layer, inputs_of(layer));
    const IntegerLayer integers = integers_of(layer, scales, inputs_of(layer));
    put_weights(integers, 0, layer.rows.size(), to.bias.size(), gnc::Int16Product::kGroup, to_, to.weight);
    put_bias(layer, scales, integers, to);
    put_output_shifts(layer, scales, to);
  }

  template <class From, class To>
  void lstm(const gnc::LayerRow& row, const From& from, To& to) {
    put_lstm_scales(row, to_.scales);
    FloatLayer layer = layer_of(row, from);
    const auto inputs = static_cast<std::size_t>(row.inputs), hidden = static_cast<std::size_t>(row.outputs);
    add_rows(layer, from.recurrent.data(), hidden);
    const std::vector<double> scales = powers_of_two(layer, inputs_of(layer));
    constexpr std::size_t kGroup = gnc::Int16Product::kGroup;
    const IntegerLayer integers = integers_of(layer, scales, inputs_of(layer));
    put_weights(integers, 0, inputs, to.bias.size(), kGroup, to_, to.weight);
    put_weights(integers, inputs, hidden, to.bias.size(), kGroup, to_, to.recurrent);
    put_bias(layer, scales, integers, to);
    put_output_shifts(layer, scales, to);
  }

  const InputStatistics& inputs_of(const FloatLayer& layer) const {
    return statistics_.inputs.at(layer.name);
  }
  const std::vector<Distribution>& outputs_of(const FloatLayer& layer) const {
    return statistics_.outputs.at(layer.name);
  }

  const gnc::NetworkWeights<Float32>& from_;
  const Statistics& statistics_;
  QuantizedNetwork& to_;
};

}  // namespace

std::unique_ptr<QuantizedNetwork> quantize(const gnc::NetworkWeights<Float32>& weights,
                                           const Statistics& statistics) {
  auto network = std::make_unique<QuantizedNetwork>();
  Quantizer(weights, statistics, *network).run();
  return network;
}

}  // namespace tumblesight::sim
