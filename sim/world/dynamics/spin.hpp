// Spin: rotation of the target at a constant rate.
#pragma once

#include <Eigen/Geometry>

namespace tumblesight::sim {

// Attitude after `time_s` at `rate_lrf_rad_s`, constant in the LiDAR frame (paper, sampling of the
// sequences):
//   q(t) = [cos(|w| t / 2), w/|w| sin(|w| t / 2)] * q0
// Returns q0 at rate zero, otherwise a unit quaternion.
Eigen::Quaterniond spin(const Eigen::Quaterniond& q0_lrf_trf, const Eigen::Vector3d& rate_lrf_rad_s,
                        double time_s);

}  // namespace tumblesight::sim
