#include "sim/evaluation/confusion.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegPerRad = 180.0 / kPi;

NearSymmetry about_z(const std::string& name, double angle_rad) {
  return {name, Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()))};
}

struct Nearest {
  std::size_t index;
  double error_deg;
};

// q_lrf_trf = truth * symmetry is the attitude that looks like the truth.
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
  if (target == "near_shoemaker") {
    symmetries.push_back(about_z("+90°", 0.5 * kPi));
    symmetries.push_back(about_z("180°", kPi));
    symmetries.push_back(about_z("−90°", -0.5 * kPi));
  }
  if (target == "magellan") symmetries.push_back(about_z("180°", kPi));
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
