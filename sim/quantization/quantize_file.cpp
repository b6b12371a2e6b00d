#include "sim/quantization/quantize_file.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/model/network_layers.hpp"
#include "sim/quantization/scales.hpp"
#include "sim/surface/target_surface.hpp"
#include "sim/world/math/angles.hpp"

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
  const auto float_models = gnc::motion_models<float>(gnc::converted<float>(inertia));
  const auto fixed_models = gnc::motion_models<gnc::Fixed>(inertia);
  std::map<std::string, Tally> tallies;
  for (const ImageSequence& sequence : sequences) {
    const Observations expected = observe<Float32>(reference, float_models, sequence);
    const Observations found = observe<FixedPoint>(network.weights, fixed_models, sequence);
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

namespace {

// One sequence in this many is kept for the report.
constexpr int kReportShare = 4;

Eigen::Quaterniond quaternion(const gnc::Matrix3<float>& rotation) {
  return Eigen::Quaterniond(rotation.cast<double>()).normalized();
}

// Angle between the attitudes of both numerics, per frame.
std::vector<double> differences_deg(const Float32Model& model, const gnc::NetworkWeights<FixedPoint>& fixed,
                                    const std::vector<ImageSequence>& sequences,
                                    const TargetSymmetry& symmetry) {
  const auto float_models = gnc::motion_models<float>(gnc::converted<float>(model.header.inertia));
  const auto fixed_models = gnc::motion_models<gnc::Fixed>(model.header.inertia);
  std::vector<double> differences;
  for (const ImageSequence& sequence : sequences) {
    const auto expected = attitudes_of<Float32>(model.weights, float_models, sequence);
    const auto found = attitudes_of<FixedPoint>(fixed, fixed_models, sequence);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Eigen::Quaterniond reference = quaternion(expected[i]);
      const Eigen::Quaterniond other =
          nearest_equivalent(quaternion(gnc::converted<float>(found[i])), reference, symmetry);
      differences.push_back(kDegPerRad * angular_error_rad(reference, other));
    }
  }
  return differences;
}

// The meshes under one set of effects.
struct Rendered {
  EffectRanges effects;
  std::vector<std::unique_ptr<FlashLidar>> lidars;
  std::vector<const FlashLidar*> each;
  Rendered(const std::vector<TriangleMesh>& meshes, const EffectRanges& set, const std::string& target)
      : effects(set) {
    for (const TriangleMesh& mesh : meshes) {
      lidars.push_back(std::make_unique<FlashLidar>(observed_bodies(effects, target, mesh)));
      each.push_back(lidars.back().get());
    }
  }
};

// Scales of no frame at all would saturate everything.
void require_frames(std::size_t calibrating, std::size_t reported) {
  if (calibrating > 0 && reported > 0) return;
  throw std::runtime_error(
      "calibration: the sensor sees too little of the target in every frame; is the surface complete and in "
      "metres, and are the effects those of the training?");
}

// The noise of the sensor, by which the flight program judges depths; the middle of a range.
gnc::RangeNoise noise_of(const ScenarioSettings& seen) {
  const double given = 0.5 * (seen.effects.low.noise + seen.effects.high.noise);
  const double factor = given > 0.0 ? given : 1.0;
  const auto rounded = [factor](double value) {
    return static_cast<std::uint16_t>(std::lround(std::min(65535.0, factor * value)));
  };
  const gnc::RangeNoise noise{rounded(1e3 * seen.sensor.noise_constant_m),
                              rounded(1e5 * seen.sensor.noise_per_range)};
  // In an image, no noise at all stands for the paper's.
  return noise == gnc::RangeNoise{0, 0} ? gnc::RangeNoise{1, 0} : noise;
}

}  // namespace

bool is_another_network(const ErrorSummary& difference) {
  constexpr double kStandardErrors = 2.0;
  return difference.mean_deg - kStandardErrors * difference.mean_standard_error_deg > kMostDifference_deg;
}

QuantizationReport quantize_to_file(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                    int sequences, const std::string& path,
                                    const std::function<void(std::uint64_t)>& progress,
                                    const ScenarioSettings& seen, const QuantizationOptions& options) {
  QuantizationReport report;
  // First: a mesh without a surface is refused before anything is rendered.
  report.surface = options.surface != nullptr
                       ? *options.surface
                       : target_surface(meshes.front(), 1e-3 * model.header.projection.target_radius_mm);
  const std::vector<EffectRanges> sets =
      options.effect_sets.empty() ? std::vector<EffectRanges>{seen.effects} : options.effect_sets;
  std::vector<Rendered> rendered;
  for (const EffectRanges& effects : sets) rendered.emplace_back(meshes, effects, model.header.target.data());
  const int held_back = sequences / kReportShare;
  Calibration calibration(model.weights,
                          gnc::motion_models<float>(gnc::converted<float>(model.header.inertia)));
  std::vector<ImageSequence> kept;
  std::size_t calibrating = 0, reported = 0;  // frames
  for (int i = 0; i < sequences; ++i) {
    const Rendered& in_turn = rendered[static_cast<std::size_t>(i) % rendered.size()];
    ScenarioSettings scenario = seen;
    scenario.effects = in_turn.effects;
    ImageSequence sequence =
        calibration_sequence(in_turn.each, model.header.projection, static_cast<std::uint64_t>(i), scenario);
    if (i < sequences - held_back) {
      calibrating += sequence.size();
      calibration.add(sequence);
    } else {
      reported += sequence.size();
      kept.push_back(std::move(sequence));
    }
    progress(static_cast<std::uint64_t>(i) + 1);
  }
  require_frames(calibrating, reported);
  const std::unique_ptr<QuantizedNetwork> network = quantize(model.weights, calibration.statistics());

  gnc::ModelHeader header = model.header;
  ScenarioSettings first = seen;
  first.effects = sets.front();
  header.noise = noise_of(first);
  report.layers = compare(model.weights, *network, model.header.inertia, kept);
  report.difference = summarise(differences_deg(model, network->weights, kept, options.symmetry));
  report.size_bytes = gnc::kModelImageSize<FixedPoint>;
  if (options.refuse_another_network && is_another_network(report.difference)) return report;
  report.crc32 = write_model_file<FixedPoint>(path, header, network->weights, report.surface);
  report.written = true;
  return report;
}

}  // namespace tumblesight::sim
