// The float32 network as ONNX models (opset 13), for other runtimes and tools. Between the two stands
// attitude algebra that is not part of them: gnc/rcnn/hypotheses.hpp and attitude_track.hpp.
#pragma once

#include <string>

#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

// A whole model, serialized: the contents of an .onnx file. The values' doc strings say what they mean; the
// metadata name target, image (CRC-32) and depth projection.
//
// Inputs:  image [1, 1, 100, 100]
// Outputs: features [1, kDense2], after ReLU; output [1, kOutput]
std::string cnn_as_onnx(const Float32Model& model);

// Inputs:  input [1, kLstmInput]; h, c [1, kLstm]
// Outputs: output [1, kHeadOutput]; h_next, c_next [1, kLstm]
// Without the bound on the cells (kLstmCellBound), which no sequence of frames reaches.
std::string recurrent_as_onnx(const Float32Model& model);

}  // namespace tumblesight::sim
