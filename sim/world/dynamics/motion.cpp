#include "sim/world/dynamics/motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tumblesight::sim {

Eigen::Quaterniond spin(const Eigen::Quaterniond& q0_lrf_trf, const Eigen::Vector3d& rate_lrf_rad_s,
                        double time_s) {
  const double rate = rate_lrf_rad_s.norm();
  if (rate == 0.0) return q0_lrf_trf;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(rate * time_s, rate_lrf_rad_s / rate));
  return (turn * q0_lrf_trf).normalized();
}

namespace {

constexpr double kMaxStep_s = 0.05;

// The state or its time derivative: quaternion (x, y, z, w), then the rate.
using Vector7d = Eigen::Matrix<double, 7, 1>;

}  // namespace

Tumble::Tumble(const Eigen::Matrix3d& inertia_trf_kg_m2) : inertia_(inertia_trf_kg_m2) {
  const bool symmetric = inertia_.isApprox(inertia_.transpose(), 1e-9);
  if (!symmetric || inertia_.llt().info() != Eigen::Success) {
    throw std::invalid_argument("the inertia must be symmetric and positive definite");
  }
  inverse_ = inertia_.inverse();
}

TumbleState Tumble::after(const TumbleState& state, double time_s) const {
  const auto derivative = [this](const Vector7d& x) {
    const Eigen::Quaterniond q(x[3], x[0], x[1], x[2]);
    const Eigen::Vector3d rate = x.tail<3>();
    Vector7d dx;
    dx.head<4>() = 0.5 * (q * Eigen::Quaterniond(0.0, rate.x(), rate.y(), rate.z())).coeffs();
    dx.tail<3>() = inverse_ * (inertia_ * rate).cross(rate);
    return dx;
  };
  Vector7d x;
  x << state.q_lrf_trf.coeffs(), state.rate_trf_rad_s;
  const int steps = std::max(1, static_cast<int>(std::ceil(time_s / kMaxStep_s)));
  const double h = time_s / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector7d k1 = derivative(x);
    const Vector7d k2 = derivative(x + 0.5 * h * k1);
    const Vector7d k3 = derivative(x + 0.5 * h * k2);
    const Vector7d k4 = derivative(x + h * k3);
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return {Eigen::Quaterniond(x[3], x[0], x[1], x[2]).normalized(), x.tail<3>()};
}

}  // namespace tumblesight::sim
