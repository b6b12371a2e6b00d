#include "sim/evaluation/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/evaluation/statistics.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

double share_within(const std::vector<double>& errors_deg, double limit_deg) {
  const auto inside =
      std::count_if(errors_deg.begin(), errors_deg.end(), [=](double e) { return e <= limit_deg; });
  return static_cast<double>(inside) / static_cast<double>(errors_deg.size());
}

}  // namespace

double angular_error_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond between = a.conjugate() * b;
  return 2.0 * std::atan2(between.vec().norm(), std::abs(between.w()));
}

bool has_estimate(const FrameResult& result, Estimator estimator) {
  return estimator == Estimator::kBaseline ? result.baseline_valid : result.valid;
}

const Eigen::Quaterniond& estimate(const FrameResult& result, Estimator estimator) {
  if (estimator == Estimator::kBaseline) return result.baseline;
  return estimator == Estimator::kRcnn ? result.rcnn : result.cnn;
}

double error_deg(const FrameResult& result, Estimator estimator) {
  if (!has_estimate(result, estimator)) return 180.0;
  return kDegPerRad * angular_error_rad(result.truth, estimate(result, estimator));
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

ErrorSummary summarise(std::vector<double> errors_deg) {
  ErrorSummary summary;
  if (errors_deg.empty()) return summary;
  // The sum of sorted values does not depend on the order of the results.
  std::sort(errors_deg.begin(), errors_deg.end());
  summary.count = errors_deg.size();
  summary.mean_deg =
      std::accumulate(errors_deg.begin(), errors_deg.end(), 0.0) / static_cast<double>(errors_deg.size());
  summary.mean_standard_error_deg = mean_standard_error(errors_deg);
  summary.within_20deg = share_within(errors_deg, 20.0);
  summary.within_5deg = share_within(errors_deg, 5.0);
  summary.median_deg = median(std::move(errors_deg));
  return summary;
}

std::vector<FrameResult> last_frames(const std::vector<FrameResult>& results, std::uint32_t frames) {
  std::vector<FrameResult> last;
  for (const FrameResult& result : results) {
    if (result.frame + 1 == frames) last.push_back(result);
  }
  return last;
}

std::vector<double> last_frame_errors_deg(const std::vector<FrameResult>& results, std::uint32_t frames,
                                          Estimator estimator) {
  std::vector<double> errors;
  for (const FrameResult& result : results) {
    if (result.frame + 1 != frames) continue;
    if (estimator == Estimator::kBaseline && !result.has_baseline) continue;
    errors.push_back(error_deg(result, estimator));
  }
  return errors;
}

}  // namespace tumblesight::sim
