// How the target rotates.
#pragma once

#include <Eigen/Geometry>

namespace tumblesight::sim {

// Spin: rotation of the target at a constant rate.
// Attitude after `time_s` at `rate_lrf_rad_s`, constant in the LiDAR frame (paper, sampling of sequences):
//   q(t) = [cos(|w| t / 2), w/|w| sin(|w| t / 2)] * q0
// Returns q0 at rate zero, otherwise a unit quaternion.
Eigen::Quaterniond spin(const Eigen::Quaterniond& q0_lrf_trf, const Eigen::Vector3d& rate_lrf_rad_s,
                        double time_s);

// Tumble: torque-free rotation of a rigid body.
struct TumbleState {
  Eigen::Quaterniond q_lrf_trf;
  Eigen::Vector3d rate_trf_rad_s;  // in body axes
};

// Euler's equation I w' = (I w) x w with q' = q (0, w) / 2 (paper, tumbling test). Integrated with the
// classical fourth-order Runge-Kutta method in steps of at most 50 ms: at 20 deg/s the error after a sequence
// is below 1e-6 rad. Rigid body, no energy dissipation, no torques.
class Tumble {
 public:
  // Throws std::invalid_argument if `inertia_trf_kg_m2` is not symmetric and positive definite.
  explicit Tumble(const Eigen::Matrix3d& inertia_trf_kg_m2);
  // State `time_s` (at least 0) after `state`.
  TumbleState after(const TumbleState& state, double time_s) const;

 private:
  Eigen::Matrix3d inertia_;
  Eigen::Matrix3d inverse_;
};

}  // namespace tumblesight::sim
