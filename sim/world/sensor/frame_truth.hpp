// FrameTruth: the true state of the world in one frame. The sensor model measures it; evaluation compares
// with it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "sim/world/sensor/occlusion.hpp"

namespace tumblesight::sim {

struct FrameTruth {
  Eigen::Quaterniond q_lrf_trf;    // unit, target frame to LiDAR frame
  Eigen::Vector3d rate_lrf_rad_s;  // of the target relative to inertial space, in the axes of the LiDAR frame
  double range_m;                  // from the sensor to the TRF's origin, along the boresight
  // Displacement of the TRF's origin from the boresight, in swaths: right (+x), up (+z).
  Eigen::Vector2d offset_swaths = Eigen::Vector2d::Zero();
  // Of the TRF's origin relative to the sensor, in axes that are those of the LiDAR frame and do not turn.
  Eigen::Vector3d velocity_lrf_m_s = Eigen::Vector3d::Zero();
  Occluder occluder{};
  std::int64_t time_ns = 0;  // of the exposure, since that of the sequence's first frame
  // The chaser's attitude: v_inertial = q_inertial_lrf v_lrf.
  Eigen::Quaterniond q_inertial_lrf = Eigen::Quaterniond::Identity();
  // Turn from the LiDAR frame as the chaser's navigation knows it to the true one: v_lrf = q_lrf_stated
  // v_stated. Not the identity where the sensor is not mounted as it should be.
  Eigen::Quaterniond q_lrf_stated = Eigen::Quaterniond::Identity();
  bool lost = false;  // the frame is not delivered
  std::uint32_t frozen_for =
      0;  // the sensor repeats the image that it took this many frames before; 0: it works
  // Of what stays the same in a sequence: the pixels that are hot, the place of debris.
  std::uint64_t scene_seed = 0;

  // Whether the sensor delivers an image, and took it at this exposure.
  bool is_genuine() const { return !lost && frozen_for == 0; }
};

}  // namespace tumblesight::sim
