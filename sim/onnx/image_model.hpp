// An ONNX model (opset 13) from the target's returns to the network's depth image, for sensors of any kind.
// It is make_depth_image() (gnc/lidar/depth_image.hpp) without the selection of the target's returns, the
// interpolation between few rays and the rounding of the 16-bit image.
#pragma once

#include <string>

#include "gnc/rcnn/model_image.hpp"

namespace tumblesight::sim {

// A serialized model, the contents of an .onnx file. Doc strings describe inputs and outputs.
//
// Inputs:  points_lrf_m [n, 3]
// Outputs: image [1, 1, 100, 100] and r_lrf_view [1, 3, 3], as step_as_onnx() takes them; distance_m [1, 1]
std::string image_as_onnx(const gnc::ModelHeader& header);

}  // namespace tumblesight::sim
