#include "sim/quantization/statistics.hpp"

#include <algorithm>

#include "gnc/rcnn/network_shape.hpp"

namespace tumblesight::sim {
namespace shape = gnc::shape;
using gnc::Float32;
namespace {

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
        inputs.add(
            neighbourhood(sample.data(), layer.side, channels, pixel / layer.side, pixel % layer.side));
      }
      continue;
    }
    const auto append = [&](const std::vector<double>& more) {
      sample.insert(sample.end(), more.begin(), more.end());
    };
    if (std::string(layer.name) == "lstm") {
      append(frame > 0 ? frame_of(observations, "lstm", frame - 1, frames)
                       : std::vector<double>(shape::kLstm, 0.0));
    }
    if (std::string(layer.name) == "head1") append(frame_of(observations, "lstm_input", frame, frames));
    inputs.add(sample);
  }
}

}  // namespace

Calibration::Calibration(const gnc::NetworkWeights<Float32>& weights, const gnc::MotionLaws<float>& laws)
    : weights_(weights), laws_(laws) {
  for (const LayerInput& layer : kLayerInputs)
    statistics_.inputs.emplace(layer.name, InputStatistics(layer.inputs));
}

void Calibration::add(const ImageSequence& sequence) {
  if (sequence.empty()) return;
  const Observations observations = observe<Float32>(weights_, laws_, sequence);
  for (const auto& [layer, values] : observations) {
    const auto channels = static_cast<std::size_t>(channels_of(layer));
    std::vector<Distribution>& outputs = statistics_.outputs[layer];
    outputs.resize(channels);
    for (std::size_t i = 0; i < values.size(); ++i) outputs[i % channels].add(values[i]);
  }
  for (const LayerInput& layer : kLayerInputs) add_samples(layer, observations, sequence.size(), statistics_);
}

}  // namespace tumblesight::sim
