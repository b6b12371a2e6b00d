// Constant-rate spin of the target.
#pragma once

#include <Eigen/Geometry>

namespace tumblesight::sim {

// Attitude after `time_s` of turning at `rate_lrf_rad_s`, constant in the LiDAR frame:
//   q(t) = [cos(|w| t / 2), w/|w| sin(|w| t / 2)] * q0   (paper, sampling of the sequences).
Eigen::Quaterniond spin(const Eigen::Quaterniond& q0_lrf_trf, const Eigen::Vector3d& rate_lrf_rad_s,
                        double time_s);

}  // namespace tumblesight::sim
