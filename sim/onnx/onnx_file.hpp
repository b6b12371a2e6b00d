// ONNX files out.
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

// <prefix>.cnn.onnx and <prefix>.recurrent.onnx. Each is written beside its place and renamed, once both are
// whole. Throws std::runtime_error that names the file.
OnnxFiles write_onnx_files(const Float32Model& model, const std::string& prefix);

}  // namespace tumblesight::sim
