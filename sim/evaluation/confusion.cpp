#include "sim/evaluation/confusion.hpp"

#include <cstdlib>

#include "sim/world/math/angles.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

// "+90°", "180°", "−90°"
std::string angle_name(int deg) {
  return (deg < 0 ? "−" : deg < 180 ? "+" : "") + std::to_string(std::abs(deg)) + "°";
}

NearSymmetry about_z(const std::string& name, double angle_rad) {
  return {name, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()))};
}

struct Nearest {
  std::size_t index;
  double error_deg;
};

// truth * symmetry is the attitude that looks like the truth.
Nearest nearest_symmetry(const FrameResult& result, Estimator estimator,
                         const std::vector<NearSymmetry>& symmetries) {
  Nearest nearest{0, 180.0};
  if (!has_estimate(result, estimator)) return nearest;
  for (std::size_t i = 0; i < symmetries.size(); ++i) {
    const double error =
        kDegPerRad * angular_error_rad(result.truth * symmetries[i].q_trf, estimate(result, estimator));
    if (error < nearest.error_deg) nearest = {i, error};
  }
  return nearest;
}

}  // namespace

std::vector<NearSymmetry> near_symmetries(const std::string& target) {
  std::vector<NearSymmetry> symmetries{about_z("right", 0.0)};
  const Mission* mission = find_target(target);
  const int fold = mission != nullptr ? mission->quasi_symmetry_about_z : 1;
  for (int i = 1; i < fold; ++i) {
    const int signed_step = 2 * i > fold ? i - fold : i;  // angles from -180 (excluded) to 180 degrees
    symmetries.push_back(about_z(angle_name(360 * signed_step / fold), 2.0 * signed_step / fold * kPi));
  }
  return symmetries;
}

Confusion confusion(const std::vector<FrameResult>& results, Estimator estimator,
                    const std::vector<NearSymmetry>& symmetries) {
  Confusion found;
  for (const NearSymmetry& symmetry : symmetries) found.names.push_back(symmetry.name);
  std::vector<std::size_t> counts(symmetries.size(), 0);
  std::vector<double> errors_deg;
  for (const FrameResult& result : results) {
    if (estimator == Estimator::kBaseline && !result.has_baseline) continue;
    const Nearest nearest = nearest_symmetry(result, estimator, symmetries);
    if (nearest.error_deg <= kConfusionLimit_deg) ++counts[nearest.index];
    errors_deg.push_back(nearest.error_deg);
  }
  found.count = errors_deg.size();
  const double all = found.count == 0 ? 1.0 : static_cast<double>(found.count);
  std::size_t classified = 0;
  for (const std::size_t count : counts) {
    found.shares.push_back(static_cast<double>(count) / all);
    classified += count;
  }
  found.none = static_cast<double>(found.count - classified) / all;
  const ErrorSummary blur = summarise(std::move(errors_deg));
  found.blur_deg = blur.mean_deg;
  found.blur_standard_error_deg = blur.mean_standard_error_deg;
  return found;
}

}  // namespace tumblesight::sim
