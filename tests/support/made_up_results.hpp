// Results with chosen errors.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "sim/evaluation/metrics.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {

inline Eigen::Quaterniond turned(double angle_deg, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * kRadPerDeg, axis.normalized()));
}

inline FrameResult result_with(std::uint32_t sequence, std::uint32_t frame, double rcnn_deg, double cnn_deg) {
  FrameResult made;
  made.sequence = sequence;
  made.frame = frame;
  made.valid = true;
  made.truth = turned(70.0, {1.0, -2.0, 0.5});
  made.rcnn = turned(rcnn_deg, {0.3, 0.1, 1.0}) * made.truth;
  made.cnn = turned(cnn_deg, {-1.0, 0.4, 0.2}) * made.truth;
  return made;
}

}  // namespace tumblesight::sim
