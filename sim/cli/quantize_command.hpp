// `tumblesight quantize`: makes the fixed-point model image that flies from a float32 one.
#pragma once

#include <string>
#include <vector>

#include "sim/model/model_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

inline constexpr int kCalibrationSequences = 200;

// Shows its progress and prints the quantization error of each layer. Throws as quantize_to_file does.
void quantize_and_report(const Float32Model& model, const std::vector<TriangleMesh>& meshes, int sequences,
                         const std::string& out);

}  // namespace tumblesight::sim
