#include "sim/world/chaser_navigation.hpp"

#include <cmath>

namespace tumblesight::sim {
namespace {

std::int32_t q30(double value) {
  constexpr double kUnit = 1 << 30;
  return static_cast<std::int32_t>(std::lround(kUnit * value));
}

}  // namespace

gnc::ChaserAttitude chaser_attitude(const FrameTruth& truth, std::int64_t time_ns, bool known) {
  if (!known) return {};
  const Eigen::Quaterniond q = truth.q_inertial_lrf * truth.q_lrf_stated;
  return {time_ns, {q30(q.w()), q30(q.x()), q30(q.y()), q30(q.z())}, true};
}

}  // namespace tumblesight::sim
