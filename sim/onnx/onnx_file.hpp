// Writes the float32 network as ONNX files.
#pragma once

#include <cstdint>
#include <string>

#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

struct OnnxFile {
  std::string path;
  std::uint64_t size_bytes;
};
struct OnnxFiles {
  OnnxFile cnn, recurrent;
};

// Writes <prefix>.cnn.onnx and <prefix>.recurrent.onnx under temporary names and renames them when both are
// complete. Throws std::runtime_error that names the file if one cannot be written.
OnnxFiles write_onnx_files(const Float32Model& model, const std::string& prefix);

}  // namespace tumblesight::sim
