// FrameTruth: the true state of the world in one frame. The sensor model measures it; evaluation compares
// with it.
#pragma once

#include <Eigen/Geometry>

#include "sim/world/sensor/occlusion.hpp"

namespace tumblesight::sim {

struct FrameTruth {
  Eigen::Quaterniond q_lrf_trf;    // unit, target frame to LiDAR frame
  Eigen::Vector3d rate_lrf_rad_s;  // of the target, in the LiDAR frame
  double range_m;                  // from the sensor to the TRF's origin, along the boresight
  // Displacement of the TRF's origin from the boresight, in swaths: right (+x), up (+z).
  Eigen::Vector2d offset_swaths = Eigen::Vector2d::Zero();
  Occluder occluder{};
};

}  // namespace tumblesight::sim
