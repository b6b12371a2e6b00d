#include "sim/quantization/quantize.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
using gnc::FixedPoint;
using gnc::Float32;
namespace {

constexpr double kLargestWeight = 127.0;
constexpr double kLargestUint8 = 255.0;
constexpr double kLargestInt16 = 32767.0 / 2.0;  // half of it: frames other than the calibration's may go beyond
constexpr double kQ15 = 1.0 / 32768.0;
constexpr int kLargestActivationShift = 24;

// A layer's float weights as [input][channel], and the real value of one unit of each input.
struct FloatLayer {
  std::string name;
  int channels;
  std::vector<const float*> rows;  // one an input: its `channels` weights
  std::vector<double> input_scale;
  const float* bias;
  double weight(std::size_t input, int channel) const { return rows[input][channel] * input_scale[input]; }
};

void add_rows(FloatLayer& layer, const float* weights, std::size_t inputs) {
  for (std::size_t i = 0; i < inputs; ++i) layer.rows.push_back(weights + i * static_cast<std::size_t>(layer.channels));
}

double largest_weight(const FloatLayer& layer, int channel) {
  double largest = 0.0;
  for (std::size_t i = 0; i < layer.rows.size(); ++i)
    largest = std::max(largest, std::abs(layer.weight(i, channel)));
  return largest;
}

// One unit of the sum of each channel, from its largest weight; for a channel without weights from its bias.
std::vector<double> sum_scales(const FloatLayer& layer, bool power_of_two) {
  std::vector<double> scales;
  for (int c = 0; c < layer.channels; ++c) {
    const double largest = std::max(largest_weight(layer, c), std::abs(static_cast<double>(layer.bias[c])) * 1e-6);
    const double scale = largest > 0.0 ? largest / kLargestWeight : 1.0;
    scales.push_back(power_of_two ? std::exp2(std::ceil(std::log2(scale))) : scale);
  }
  return scales;
}

// The integers of a layer, [input][channel], and what is to be added to each sum to make up for their rounding on
// average.
struct IntegerLayer {
  Eigen::MatrixXd weight;
  Eigen::VectorXd rounded_away;
};
IntegerLayer integers_of(const FloatLayer& layer, const std::vector<double>& scales, const InputStatistics& inputs) {
  const auto count = static_cast<Eigen::Index>(layer.rows.size());
  const Eigen::VectorXd unit = Eigen::Map<const Eigen::VectorXd>(layer.input_scale.data(), count).cwiseInverse();
  Eigen::MatrixXd exact(count, layer.channels);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int c = 0; c < layer.channels; ++c) exact(i, c) = layer.weight(static_cast<std::size_t>(i), c) / scales[c];
  }
  const Eigen::MatrixXd covariance = unit.asDiagonal() * inputs.covariance() * unit.asDiagonal();
  const Eigen::MatrixXd integers = rounded(exact, covariance, kLargestWeight);
  const Eigen::VectorXd mean = unit.cwiseProduct(inputs.mean());
  return {integers, (exact - integers).transpose() * mean};
}

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
  weights.lie_at(bytes.data());
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

// Shifts such that each channel's largest value still fits; notes what a unit of the output is worth.
template <class Weights>
void put_activation_shifts(const FloatLayer& layer, const std::vector<double>& scales,
                           const std::vector<double>& largest, double largest_integer, QuantizedNetwork& network,
                           Weights& weights) {
  std::vector<double>& out = network.scales[layer.name];
  for (int c = 0; c < layer.channels; ++c) {
    const double steps = largest.at(c) / scales[c] / largest_integer;
    const int shift = steps > 2.0 ? static_cast<int>(std::ceil(std::log2(steps))) : 1;
    weights.shift[c] = static_cast<std::uint8_t>(std::min(shift, kLargestActivationShift));
    out.push_back(std::ldexp(scales[c], weights.shift[c]));
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
    // The range is that of means of four; each of the four may be their whole sum.
    convolution("conv4", from_.conv4, "conv3", weights.conv4, gnc::kLargestOfFour / 4.0);
    for (double& scale : to_.scales.at("conv4")) scale /= 4.0;  // the sum of a window stands for its mean
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
    for (int i = 0; i < times; ++i) units.insert(units.end(), to_.scales.at(layer).begin(), to_.scales.at(layer).end());
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

  template <class From, class To>
  void convolution(const std::string& name, const From& from, const std::string& before, To& to,
                   double largest_integer = kLargestUint8) {
    const FloatLayer layer = layer_of(name, from, unit_of(before, 9));
    const std::vector<double> scales = sum_scales(layer, false);
    const IntegerLayer integers = integers_of(layer, scales, statistics_.inputs.at(name));
    put_weights(integers, 0, layer.rows.size(), to.bias.size(), gnc::Int8Product::kGroup, to_, to.weight);
    put_bias(layer, scales, integers, to);
    put_activation_shifts(layer, scales, statistics_.largest.at(name), largest_integer, to_, to);
  }

  template <class From, class To>
  void hidden(const std::string& name, const From& from, const std::vector<double>& units, To& to) {
    const FloatLayer layer = layer_of(name, from, units);
    const std::vector<double> scales = sum_scales(layer, false);
    const IntegerLayer integers = integers_of(layer, scales, statistics_.inputs.at(name));
    put_weights(integers, 0, layer.rows.size(), to.bias.size(), gnc::Int16Product::kGroup, to_, to.weight);
    put_bias(layer, scales, integers, to);
    put_activation_shifts(layer, scales, statistics_.largest.at(name), kLargestInt16, to_, to);
  }

  template <class From, class To>
  void output(const std::string& name, const From& from, const std::vector<double>& units, To& to) {
    const FloatLayer layer = layer_of(name, from, units);
    const std::vector<double> scales = sum_scales(layer, true);
    const IntegerLayer integers = integers_of(layer, scales, statistics_.inputs.at(name));
    put_weights(integers, 0, layer.rows.size(), to.bias.size(), gnc::Int16Product::kGroup, to_, to.weight);
    put_bias(layer, scales, integers, to);
    put_output_shifts(layer, scales, to);
  }

  template <class To>
  void lstm(const std::vector<double>& units, To& to) {
    FloatLayer layer = layer_of("lstm", from_.lstm, units);
    add_rows(layer, from_.lstm.recurrent.data(), shape::kLstm);
    const std::vector<double> scales = sum_scales(layer, true);
    constexpr std::size_t kGroup = gnc::Int16Product::kGroup;
    const IntegerLayer integers = integers_of(layer, scales, statistics_.inputs.at("lstm"));
    put_weights(integers, 0, shape::kLstmInput, to.bias.size(), kGroup, to_, to.weight);
    put_weights(integers, shape::kLstmInput, shape::kLstm, to.bias.size(), kGroup, to_, to.recurrent);
    put_bias(layer, scales, integers, to);
    put_output_shifts(layer, scales, to);
  }

  const gnc::NetworkWeights<Float32>& from_;
  const Statistics& statistics_;
  QuantizedNetwork& to_;
};

double largest_integer(const std::string& layer) {
  if (layer == "conv4") return 4.0 * gnc::kLargestOfFour;
  return layer.compare(0, 4, "conv") == 0 ? kLargestUint8 : 32767.0;
}

// Where a layer's inputs are observed.
struct LayerInput {
  const char* name;
  const char* from;
  int side;  // of a convolution's input image; 0 for a dense layer
  int inputs;
};
constexpr int kHalf = shape::kImageSide / 2;
constexpr LayerInput kLayerInputs[] = {
    {"conv1", "depth", kHalf, 9 * shape::kSpaceToDepthChannels},
    {"conv2", "conv1", kHalf / 2, 9 * shape::kConv1},
    {"conv3", "conv2", kHalf / 4, 9 * shape::kConv2},
    {"conv4", "conv3", kHalf / 8, 9 * shape::kConv3},
    {"dense1", "conv4", 0, shape::kFlat},
    {"dense2", "dense1", 0, shape::kDense1},
    {"cnn_out", "dense2", 0, shape::kDense2},
    {"lstm", "lstm_input", 0, shape::kLstmInput + shape::kLstm},
    {"head1", "lstm", 0, shape::kLstm + shape::kLstmInput},
    {"head2", "head1", 0, shape::kHead},
};

// The 3x3 neighbourhood of a pixel, zeros outside the image.
std::vector<double> neighbourhood(const double* image, int side, int channels, int y, int x) {
  std::vector<double> sample(9U * static_cast<std::size_t>(channels), 0.0);
  for (int tap = 0; tap < 9; ++tap) {
    const int from_y = y + tap / 3 - 1, from_x = x + tap % 3 - 1;
    if (from_y < 0 || from_y >= side || from_x < 0 || from_x >= side) continue;
    std::copy_n(image + (from_y * side + from_x) * channels, channels, sample.begin() + tap * channels);
  }
  return sample;
}

// At most this many pixels of an image, spread over it.
constexpr int kPixelsPerImage = 36;

std::vector<double> frame_of(const Observations& observations, const std::string& layer, std::size_t frame,
                             std::size_t frames) {
  const std::vector<double>& all = observations.at(layer);
  const std::size_t size = all.size() / frames;
  return {all.begin() + static_cast<std::ptrdiff_t>(frame * size),
          all.begin() + static_cast<std::ptrdiff_t>((frame + 1) * size)};
}

void add_samples(const LayerInput& layer, const Observations& observations, std::size_t frames,
                 Statistics& statistics) {
  InputStatistics& inputs = statistics.inputs.at(layer.name);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    std::vector<double> sample = frame_of(observations, layer.from, frame, frames);
    if (layer.side > 0) {
      const int channels = layer.inputs / 9;
      const int pixels = layer.side * layer.side;
      const int step = std::max(1, pixels / kPixelsPerImage);
      for (int pixel = static_cast<int>(frame) % step; pixel < pixels; pixel += step) {
        inputs.add(neighbourhood(sample.data(), layer.side, channels, pixel / layer.side, pixel % layer.side));
      }
      continue;
    }
    const auto append = [&](const std::vector<double>& more) { sample.insert(sample.end(), more.begin(), more.end()); };
    if (std::string(layer.name) == "lstm") {
      append(frame > 0 ? frame_of(observations, "lstm", frame - 1, frames) : std::vector<double>(shape::kLstm, 0.0));
    }
    if (std::string(layer.name) == "head1") append(frame_of(observations, "lstm_input", frame, frames));
    inputs.add(sample);
  }
}

struct Tally {
  double largest = 0.0, signal = 0.0, noise = 0.0, saturated = 0.0, count = 0.0;
};

}  // namespace

Calibration::Calibration(const gnc::NetworkWeights<Float32>& weights, const gnc::MotionLaws<float>& laws)
    : weights_(weights), laws_(laws) {
  for (const LayerInput& layer : kLayerInputs) statistics_.inputs.emplace(layer.name, InputStatistics(layer.inputs));
}

void Calibration::add(const ImageSequence& sequence) {
  if (sequence.empty()) return;
  const Observations observations = observe<Float32>(weights_, laws_, sequence);
  for (const auto& [layer, values] : observations) {
    const auto channels = static_cast<std::size_t>(channels_of(layer));
    std::vector<double>& largest = statistics_.largest[layer];
    largest.resize(channels, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) largest[i % channels] = std::max(largest[i % channels], values[i]);
  }
  for (const LayerInput& layer : kLayerInputs) add_samples(layer, observations, sequence.size(), statistics_);
}

std::unique_ptr<QuantizedNetwork> quantize(const gnc::NetworkWeights<Float32>& weights, const Statistics& statistics) {
  auto network = std::make_unique<QuantizedNetwork>();
  Quantizer(weights, statistics, *network).run();
  return network;
}

std::vector<LayerReport> compare(const gnc::NetworkWeights<Float32>& reference, const QuantizedNetwork& network,
                                 const gnc::Inertia<gnc::Fixed>& inertia,
                                 const std::vector<ImageSequence>& sequences) {
  const auto float_laws = gnc::motion_laws<float>(gnc::converted<float>(inertia));
  const auto fixed_laws = gnc::motion_laws<gnc::Fixed>(inertia);
  std::map<std::string, Tally> tallies;
  for (const ImageSequence& sequence : sequences) {
    const Observations expected = observe<Float32>(reference, float_laws, sequence);
    const Observations found = observe<FixedPoint>(network.weights, fixed_laws, sequence);
    for (const auto& [layer, values] : expected) {
      Tally& tally = tallies[layer];
      const std::vector<double>& scales = network.scales.at(layer);
      const std::vector<double>& integers = found.at(layer);
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double difference = integers[i] * scales[i % scales.size()] - values[i];
        tally.largest = std::max(tally.largest, std::abs(values[i]));
        tally.signal += values[i] * values[i];
        tally.noise += difference * difference;
        tally.saturated += std::abs(integers[i]) >= largest_integer(layer) ? 1.0 : 0.0;
        tally.count += 1.0;
      }
    }
  }
  std::vector<LayerReport> report;
  for (const char* layer : {"conv1", "conv2", "conv3", "conv4", "dense1", "dense2", "lstm", "head1"}) {
    const Tally& tally = tallies[layer];
    report.push_back({layer, tally.largest, tally.saturated / std::max(1.0, tally.count),
                      10.0 * std::log10(std::max(1e-30, tally.signal) / std::max(1e-30, tally.noise))});
  }
  return report;
}

}  // namespace tumblesight::sim
