// Quantization with its progress and its report on the terminal, for the verbs that make model images.
#pragma once

#include <string>
#include <vector>

#include "sim/model/model_file.hpp"
#include "sim/quantization/quantize_file.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

inline constexpr int kCalibrationSequences = 200;

// Shows its progress and prints the quantization error of each layer. Throws as quantize_to_file does.
// `seen`: sensor, ranges and period of the sequences, which take turns among `effect_sets`. Returns the
// report, by which the caller judges the image; with `refuse_another_network` it may not be written.
QuantizationReport quantize_and_report(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                       int sequences, const std::string& out, const ScenarioSettings& seen,
                                       const std::vector<EffectRanges>& effect_sets,
                                       const TargetSymmetry& symmetry = {},
                                       bool refuse_another_network = false);

}  // namespace tumblesight::sim
