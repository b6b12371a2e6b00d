// Calibrates and quantizes a float32 model, writes the fixed-point image and reports the losses.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/model/model_file.hpp"
#include "sim/quantization/calibration.hpp"
#include "sim/quantization/quantize.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct LayerReport {
  std::string layer;
  double largest = 0.0;    // largest magnitude of the float32 network's outputs
  double saturated = 0.0;  // share of the fixed-point outputs at the end of their range, 0 to 1
  double snr_db = 0.0;     // power of the float32 outputs over that of the difference
};
// One row per hidden layer. `sequences` should not be those that the scales were chosen on.
std::vector<LayerReport> compare(const gnc::NetworkWeights<gnc::Float32>& reference,
                                 const QuantizedNetwork& network, const gnc::Inertia<gnc::Fixed>& inertia,
                                 const std::vector<ImageSequence>& sequences);

// Above this mean the image in fixed point is another network than the one in float32. The shipped networks
// have 0.25 to 1.0 degrees on their own meshes: a few frames of nearly symmetric NEAR in which the numerics
// choose differently make up most of its 1.0.
inline constexpr double kMostDifference_deg = 5.0;
// Whether the mean is above kMostDifference_deg by more than two standard errors: with few frames a single
// one that differs is no proof.
bool is_another_network(const ErrorSummary& difference);

struct QuantizationReport {
  std::vector<LayerReport> layers;
  ErrorSummary difference;  // angles between the attitudes of both numerics, one per frame
  std::size_t size_bytes = 0;
  std::uint32_t crc32 = 0;
  SurfaceSections surface;  // in the image
  bool written = false;
};
struct QuantizationOptions {
  TargetSymmetry symmetry{};            // of the target: attitudes that look the same do not differ
  bool refuse_another_network = false;  // nothing is written if is_another_network()
  // The sequences take turns among these, in place of the effects of `seen`; empty: those of `seen`. The
  // noise that the image notes is that of the first.
  std::vector<EffectRanges> effect_sets{};
  // That of the first mesh where it is known, since making it takes seconds.
  const SurfaceSections* surface = nullptr;
};
// Renders `sequences` sequences: three quarters calibrate, the last quarter is for the report. The first mesh
// gives the image's surface, and the sensor its noise. Calls `progress` with the number of sequences done.
// `seen`: sensor, ranges, period and effects of the sequences, as the network is trained for. Deterministic.
// Throws std::runtime_error if the sensor sees too little of the target in all frames of one of the two
// parts, or that names the file if it cannot be written, and as observed_bodies() and target_surface() do.
QuantizationReport quantize_to_file(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                    int sequences, const std::string& path,
                                    const std::function<void(std::uint64_t)>& progress,
                                    const ScenarioSettings& seen = {},
                                    const QuantizationOptions& options = {});

}  // namespace tumblesight::sim
