// An ONNX model with an empty graph.
#pragma once

#include <onnx/onnx_pb.h>

#include <string>

#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::sim {

// Opset 13. The metadata contain target, CRC-32 of the model image, depth projection, the target's inertia,
// the nominal period, and units and frames in words. `graph`: its name.
onnx::ModelProto new_model(const gnc::ModelHeader& header, const std::string& graph,
                           const std::string& description);

}  // namespace tumblesight::sim
