// The CNN in int8 as an ONNX model, for ONNX Runtime: QLinearConv, and com.microsoft's QGemm, since ONNX has
// no quantized product with a bias. Scales and what they lose: sim/model/int8_layers.hpp.
#pragma once

#include <string>

#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::sim {

// A serialized model.
// Input:   image [1, 1, 100, 100], uint8: min(255, (depth + 128) >> 8)
// Outputs: features [1, kDense2], float32, in counts; output [1, kOutput], float32
std::string int8_cnn_as_onnx(const gnc::ModelHeader& header,
                             const gnc::NetworkWeights<gnc::FixedPoint>& weights);

}  // namespace tumblesight::sim
