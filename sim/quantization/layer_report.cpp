#include "sim/quantization/layer_report.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/network_layers.hpp"
#include "sim/quantization/scales.hpp"

namespace tumblesight::sim {
using gnc::FixedPoint;
using gnc::Float32;
namespace {

// Largest integer of the layer's outputs. Network inputs are not reported, so their value has no effect.
double largest_integer(const std::string& name) {
  const int index = gnc::layer_index(name.c_str());
  if (index == gnc::kLayerCount) return 32767.0;
  switch (gnc::kLayers[index].output) {
    case gnc::LayerOutput::kMaxPooled:
      return kLargestUint8;
    case gnc::LayerOutput::kAveragePooled:
      return 4.0 * gnc::kMaxAveragedActivation;
    case gnc::LayerOutput::kHidden:
    case gnc::LayerOutput::kOutput:
      break;
  }
  return 32767.0;
}

struct Tally {
  double largest = 0.0, signal = 0.0, noise = 0.0, saturated = 0.0, count = 0.0;
};

}  // namespace

std::vector<LayerReport> compare(const gnc::NetworkWeights<Float32>& reference,
                                 const QuantizedNetwork& network, const gnc::Inertia<gnc::Fixed>& inertia,
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
  for (const gnc::LayerRow& row : gnc::kLayers) {
    if (!is_hidden(row)) continue;
    const Tally& tally = tallies[row.name];
    report.push_back({row.name, tally.largest, tally.saturated / std::max(1.0, tally.count),
                      10.0 * std::log10(std::max(1e-30, tally.signal) / std::max(1e-30, tally.noise))});
  }
  return report;
}

}  // namespace tumblesight::sim
