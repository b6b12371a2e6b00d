// From an output vector of the network to one attitude with its expected error.
#pragma once

#include <Eigen/Geometry>

#include "gnc/rcnn/network.hpp"

namespace tumblesight::gnc {

struct DecodedAttitude {
  Eigen::Quaternionf q_lrf_trf;
  float predicted_error_rad;  // 0..pi
};

// The hypothesis with the largest logit (the first of equals). Always a unit quaternion with w >= 0; where
// the hypothesis is not finite, the identity with a predicted error of pi.
DecodedAttitude decode_output(const OutputVector& output);

}  // namespace tumblesight::gnc
