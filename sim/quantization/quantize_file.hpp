// The whole way from a float32 model to the fixed-point image that flies, and what was lost on it.
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
  ErrorSummary difference;  // between the attitudes of both numerics, a frame each
  std::size_t size_bytes = 0;
  std::uint32_t crc32 = 0;
};
// Calibrates on most of `sequences` rendered sequences, reports on the rest, and writes the image.
// `progress`: sequences done. Throws std::runtime_error that names the file.
QuantizationReport quantize_to_file(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                    int sequences, const std::string& path,
                                    const std::function<void(std::uint64_t)>& progress);

}  // namespace tumblesight::sim
