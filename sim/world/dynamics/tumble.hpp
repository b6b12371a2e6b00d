// Torque-free rotation of a rigid body.
#pragma once

#include <Eigen/Geometry>

namespace tumblesight::sim {

struct TumbleState {
  Eigen::Quaterniond q_lrf_trf;
  Eigen::Vector3d rate_trf_rad_s;  // body axes
};

// Euler's equation I w' = (I w) x w with q' = q (0, w) / 2 (paper, tumbling test), integrated by a classical
// Runge-Kutta method in steps of at most 50 ms: at 20 deg/s the error of a sequence stays below 1e-6 rad.
class Tumble {
 public:
  // `inertia_trf_kg_m2` must be symmetric and positive definite; throws std::invalid_argument if not.
  explicit Tumble(const Eigen::Matrix3d& inertia_trf_kg_m2);
  TumbleState after(const TumbleState& state, double time_s) const;

 private:
  Eigen::Matrix3d inertia_;
  Eigen::Matrix3d inverse_;
};

}  // namespace tumblesight::sim
