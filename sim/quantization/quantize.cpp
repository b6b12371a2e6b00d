#include "sim/quantization/quantize.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gnc/rcnn/network_shape.hpp"
#include "sim/quantization/scales.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
using gnc::FixedPoint;
using gnc::Float32;
namespace {

constexpr double kLargestInt16 =
    32767.0 / 2.0;  // half of it: frames other than the calibration's may go beyond
constexpr double kQ15 = 1.0 / 32768.0;

std::int32_t to_integer(double value) {
  return static_cast<std::int32_t>(std::lround(std::min(2147483647.0, std::max(-2147483647.0, value))));
}

// Weights of the inputs [first, first + count) in groups, as the kernels want them.
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
    weights.bias[c] = to_integer(layer.bias[c] / scales[c] + integers.rounded_away[c]);
  }
}

// Shifts from the sum, whose unit is a power of two, to 24 bits behind the point.
template <class Weights>
void put_output_shifts(const FloatLayer& layer, const std::vector<double>& scales, Weights& weights) {
  for (int c = 0; c < layer.channels; ++c) {
    const double shift = -std::log2(scales[c]);
    if (shift < 1.0 || shift > 62.0) {
      throw std::runtime_error(layer.name + ", channel " + std::to_string(c) + ": weights up to " +
                               std::to_string(largest_weight(layer, c)) + " have no place in fixed point");
    }
    weights.shift[c] = static_cast<std::uint8_t>(shift);
  }
}

class Quantizer {
 public:
  Quantizer(const gnc::NetworkWeights<Float32>& from, const Statistics& statistics, QuantizedNetwork& to)
      : from_(from), statistics_(statistics), to_(to) {}

  void run() {
    auto& weights = to_.weights;
    to_.scales["depth"].assign(shape::kSpaceToDepthChannels, 1.0 / 256.0);
    convolution("conv1", from_.conv1, "depth", weights.conv1);
    convolution("conv2", from_.conv2, "conv1", weights.conv2);
    convolution("conv3", from_.conv3, "conv2", weights.conv3);
    last_convolution("conv4", from_.conv4, "conv3", weights.conv4);
    hidden("dense1", from_.dense1, unit_of("conv4", shape::kFlat / shape::kConv4), weights.dense1);
    hidden("dense2", from_.dense2, unit_of("dense1"), weights.dense2);
    output("cnn_out", from_.cnn_out, unit_of("dense2"), weights.cnn_out);

    to_.scales["lstm_input"] = to_.scales.at("dense2");
    to_.scales["lstm_input"].resize(shape::kLstmInput, kQ15);
    to_.scales["lstm"].assign(shape::kLstm, kQ15);
    lstm(joined(unit_of("lstm_input"), unit_of("lstm")), weights.lstm);
    hidden("head1", from_.head1, joined(unit_of("lstm"), unit_of("lstm_input")), weights.head1);
    output("head2", from_.head2, unit_of("head1"), weights.head2);
  }

 private:
  // The unit of each of a layer's inputs, which `layer` gives.
  std::vector<double> unit_of(const std::string& layer, int times = 1) const {
    std::vector<double> units;
    for (int i = 0; i < times; ++i)
      units.insert(units.end(), to_.scales.at(layer).begin(), to_.scales.at(layer).end());
    return units;
  }
  static std::vector<double> joined(std::vector<double> a, const std::vector<double>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }

  template <class From>
  static FloatLayer layer_of(const std::string& name, const From& from, const std::vector<double>& units) {
    FloatLayer layer{name, static_cast<int>(from.bias.size()), {}, units, from.bias.data()};
    add_rows(layer, from.weight.data(), from.weight.size() / from.bias.size());
    return layer;
  }

  // One with outputs of 8 bits; the last one's means of four have bits to spare.
  template <class From, class To>
  void convolution(const std::string& name, const From& from, const std::string& before, To& to) {
    const FloatLayer layer = layer_of(name, from, unit_of(before, 9));
    put<gnc::Int8Product::kGroup>(
        layer, scales_of_few_bits(layer, inputs_of(layer), outputs_of(layer), kLargestUint8), to);
  }
  template <class From, class To>
  void last_convolution(const std::string& name, const From& from, const std::string& before, To& to) {
    const FloatLayer layer = layer_of(name, from, unit_of(before, 9));
    // The range is that of means of four; each of the four may be their whole sum.
    put<gnc::Int8Product::kGroup>(
        layer, scales_of_many_bits(layer, outputs_of(layer), gnc::kMaxAveragedActivation / 4.0), to);
    for (double& scale : to_.scales.at(name)) scale /= 4.0;  // the sum of a window stands for its mean
  }
  template <class From, class To>
  void hidden(const std::string& name, const From& from, const std::vector<double>& units, To& to) {
    const FloatLayer layer = layer_of(name, from, units);
    put<gnc::Int16Product::kGroup>(layer, scales_of_many_bits(layer, outputs_of(layer), kLargestInt16), to);
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
  void output(const std::string& name, const From& from, const std::vector<double>& units, To& to) {
    const FloatLayer layer = layer_of(name, from, units);
    const std::vector<double> scales = powers_of_two(layer, inputs_of(layer));
    const IntegerLayer integers = integers_of(layer, scales, inputs_of(layer));
    put_weights(integers, 0, layer.rows.size(), to.bias.size(), gnc::Int16Product::kGroup, to_, to.weight);
    put_bias(layer, scales, integers, to);
    put_output_shifts(layer, scales, to);
  }

  template <class To>
  void lstm(const std::vector<double>& units, To& to) {
    FloatLayer layer = layer_of("lstm", from_.lstm, units);
    add_rows(layer, from_.lstm.recurrent.data(), shape::kLstm);
    const std::vector<double> scales = powers_of_two(layer, inputs_of(layer));
    constexpr std::size_t kGroup = gnc::Int16Product::kGroup;
    const IntegerLayer integers = integers_of(layer, scales, inputs_of(layer));
    put_weights(integers, 0, shape::kLstmInput, to.bias.size(), kGroup, to_, to.weight);
    put_weights(integers, shape::kLstmInput, shape::kLstm, to.bias.size(), kGroup, to_, to.recurrent);
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
