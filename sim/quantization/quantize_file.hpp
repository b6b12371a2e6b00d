// Calibrates and quantizes a float32 model, writes the fixed-point image and reports the losses.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/model/model_file.hpp"
#include "sim/quantization/layer_report.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct QuantizationReport {
  std::vector<LayerReport> layers;
  ErrorSummary difference;  // angles between the attitudes of both numerics, one per frame
  std::size_t size_bytes = 0;
  std::uint32_t crc32 = 0;
};
// Renders `sequences` sequences: three quarters calibrate, the last quarter is for the report. Calls
// `progress` with the number of sequences done. Deterministic. Throws std::runtime_error that names the file
// if it cannot be written.
QuantizationReport quantize_to_file(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                    int sequences, const std::string& path,
                                    const std::function<void(std::uint64_t)>& progress);

}  // namespace tumblesight::sim
