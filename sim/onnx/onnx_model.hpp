// The two parts of the float32 network as ONNX models (opset 13), for tools that measure or convert networks.
// The attitude algebra between the two is part of the whole step only: step_model.hpp.
#pragma once

#include <string>

#include "sim/model/model_file.hpp"

namespace tumblesight::sim {

// Each returns a serialized model, the contents of an .onnx file. Doc strings describe inputs and outputs;
// the metadata: new_model.hpp.
//
// Inputs:  image [1, 1, 100, 100]
// Outputs: features [1, kDense2], after ReLU; output [1, kOutput]
std::string cnn_as_onnx(const Float32Model& model);

// Inputs:  input [1, kLstmInput]; h, c [1, kLstm]
// Outputs: output [1, kHeadOutput]; h_next, c_next [1, kLstm]
// The bound on the cells (kLstmCellBound) is left out: no sequence of frames reaches it.
std::string recurrent_as_onnx(const Float32Model& model);

}  // namespace tumblesight::sim
