#include "sim/world/dynamics/spin.hpp"

namespace tumblesight::sim {

Eigen::Quaterniond spin(const Eigen::Quaterniond& q0_lrf_trf, const Eigen::Vector3d& rate_lrf_rad_s,
                        double time_s) {
  const double rate = rate_lrf_rad_s.norm();
  if (rate == 0.0) return q0_lrf_trf;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(rate * time_s, rate_lrf_rad_s / rate));
  return (turn * q0_lrf_trf).normalized();
}

}  // namespace tumblesight::sim
