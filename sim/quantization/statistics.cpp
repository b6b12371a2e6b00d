#include "sim/quantization/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/network_layers.hpp"

namespace tumblesight::sim {

using gnc::Float32;

namespace {

constexpr double kBinsPerOctave = 32.0;

}  // namespace

void Distribution::add(double value) {
  count_ += 1.0;
  if (!(value > 0.0)) return;
  largest_ = std::max(largest_, value);
  counts_[static_cast<int>(std::floor(kBinsPerOctave * std::log2(value)))] += 1.0;
}

double Distribution::squared_loss(double unit, double largest_integer) const {
  double sum = 0.0;
  for (const auto& [bin, count] : counts_) {
    const double value = std::exp2((bin + 0.5) / kBinsPerOctave);
    const double beyond = value - unit * largest_integer;
    const double rounding = value < 0.5 * unit ? value * value : unit * unit / 12.0;
    sum += count * (beyond > 0.0 ? beyond * beyond : rounding);
  }
  return sum / std::max(1.0, count_);
}

namespace {

// The neighbourhood of a pixel that a sum reads, zeros outside the image.
std::vector<double> neighbourhood(const gnc::LayerRow& row, const double* image, int y, int x) {
  const int window = sums_of(row.kind).window, side = row.side, channels = row.inputs;
  std::vector<double> sample(static_cast<std::size_t>(inputs_per_sum(row)), 0.0);
  for (int tap = 0; tap < window * window; ++tap) {
    const int from_y = y + tap / window - window / 2, from_x = x + tap % window - window / 2;
    if (from_y < 0 || from_y >= side || from_x < 0 || from_x >= side) continue;
    std::copy_n(image + (from_y * side + from_x) * channels, channels, sample.begin() + tap * channels);
  }
  return sample;
}

// About this many pixels per image are sampled, at regular intervals. The first one differs from frame to
// frame.
constexpr int kPixelsPerImage = 36;

std::vector<double> frame_of(const Observations& observations, const std::string& layer, std::size_t frame,
                             std::size_t frames) {
  const std::vector<double>& all = observations.at(layer);
  const std::size_t size = all.size() / frames;
  return {all.begin() + static_cast<std::ptrdiff_t>(frame * size),
          all.begin() + static_cast<std::ptrdiff_t>((frame + 1) * size)};
}

void add_windows(const gnc::LayerRow& row, const std::vector<double>& image, std::size_t frame,
                 InputStatistics& inputs) {
  const int pixels = row.side * row.side;
  const int step = std::max(1, pixels / kPixelsPerImage);
  for (int pixel = static_cast<int>(frame) % step; pixel < pixels; pixel += step) {
    inputs.add(neighbourhood(row, image.data(), pixel / row.side, pixel % row.side));
  }
}

void add_samples(const gnc::LayerRow& row, const Observations& observations, std::size_t frames,
                 InputStatistics& inputs) {
  for (std::size_t frame = 0; frame < frames; ++frame) {
    std::vector<double> sample;
    const auto append = [&sample](const std::vector<double>& more) {
      sample.insert(sample.end(), more.begin(), more.end());
    };
    for (const std::string& name : reads_of(row)) append(frame_of(observations, name, frame, frames));
    if (is_image_layer(row)) {
      add_windows(row, sample, frame, inputs);
      continue;
    }
    if (sums_of(row.kind).read_state) {  // the outputs of the frame before
      append(frame > 0 ? frame_of(observations, row.name, frame - 1, frames)
                       : std::vector<double>(static_cast<std::size_t>(row.outputs), 0.0));
    }
    inputs.add(sample);
  }
}

}  // namespace

Calibration::Calibration(const gnc::NetworkWeights<Float32>& weights,
                         const gnc::MotionModels<float>& motion_models)
    : weights_(weights), motion_models_(motion_models) {
  for (const gnc::LayerRow& row : gnc::kLayers)
    statistics_.inputs.emplace(row.name, InputStatistics(inputs_per_sum(row)));
}

void Calibration::add(const ImageSequence& sequence) {
  if (sequence.empty()) return;
  const Observations observations = observe<Float32>(weights_, motion_models_, sequence);
  for (const auto& [layer, values] : observations) {
    const auto channels = static_cast<std::size_t>(channels_of(layer));
    std::vector<Distribution>& outputs = statistics_.outputs[layer];
    outputs.resize(channels);
    for (std::size_t i = 0; i < values.size(); ++i) outputs[i % channels].add(values[i]);
  }
  for (const gnc::LayerRow& row : gnc::kLayers)
    add_samples(row, observations, sequence.size(), statistics_.inputs.at(row.name));
}

}  // namespace tumblesight::sim
