// The float32 network as ONNX models (opset 13), for other runtimes and tools: the whole step, which is the one
// to run (step_model.hpp), and its two parts with weights alone, for tools that measure or convert networks.
// The attitude algebra between the two parts is in the step only.
#pragma once

#include <cstdint>
#include <string>

#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

// Each returns a serialized model, the contents of an .onnx file. Doc strings describe inputs and outputs;
// the metadata contain target, CRC-32 of the model image and depth projection.
//
// Inputs:  image [1, 1, 100, 100]
// Outputs: features [1, kDense2], after ReLU; output [1, kOutput]
std::string cnn_as_onnx(const Float32Model& model);

// Inputs:  input [1, kLstmInput]; h, c [1, kLstm]
// Outputs: output [1, kHeadOutput]; h_next, c_next [1, kLstm]
// The bound on the cells (kLstmCellBound) is left out: no sequence of frames reaches it.
std::string recurrent_as_onnx(const Float32Model& model);

struct OnnxFile {
  std::string path;
  std::uint64_t size_bytes;
};
struct OnnxFiles {
  OnnxFile step, cnn, recurrent;
};

// Writes <prefix>.step.onnx, <prefix>.cnn.onnx and <prefix>.recurrent.onnx, each as a whole. Throws
// std::runtime_error that names the file if one cannot be written.
OnnxFiles write_onnx_files(const Float32Model& model, const std::string& prefix);

}  // namespace tumblesight::sim
