#include "sim/evaluation/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "sim/evaluation/statistics.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kExpectedErrors = 3.0;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double share_within(const std::vector<double>& errors_deg, double limit_deg) {
  const auto inside =
      std::count_if(errors_deg.begin(), errors_deg.end(), [=](double e) { return e <= limit_deg; });
  return static_cast<double>(inside) / static_cast<double>(errors_deg.size());
}

// The last frames in which `estimator` was run.
std::vector<FrameResult> last_frames_of(const std::vector<FrameResult>& results, std::uint32_t frames,
                                        Estimator estimator) {
  std::vector<FrameResult> last = last_frames(results, frames);
  const auto was_not_run = [=](const FrameResult& result) {
    return estimator == Estimator::kBaseline && !result.has_baseline;
  };
  last.erase(std::remove_if(last.begin(), last.end(), was_not_run), last.end());
  return last;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The expected errors of one estimator against the real ones.
void compare_expected(const std::vector<FrameResult>& results, Estimator estimator, ErrorSummary& summary) {
  double expected_deg = 0.0;
  double real_deg = 0.0;
  std::size_t below = 0;
  std::size_t count = 0;
  for (const FrameResult& result : results) {
    if (!has_estimate(result, estimator)) continue;
    const bool rcnn = estimator == Estimator::kRcnn;
    const double one_deg = kDegPerRad * (rcnn ? result.rcnn_predicted_rad : result.cnn_predicted_rad);
    expected_deg += one_deg;
    real_deg += error_deg(result, estimator);
    below += error_deg(result, estimator) < kExpectedErrors * one_deg ? 1 : 0;
    ++count;
  }
  if (count == 0) return;
  summary.error_below_3_expected = static_cast<double>(below) / static_cast<double>(count);
  if (real_deg > 0.0) summary.expected_over_real = expected_deg / real_deg;
}

bool is_trusted(const FrameResult& result, Estimator estimator) {
  return estimator == Estimator::kBaseline ? result.baseline_valid : result.trusted;
}

}  // namespace

double angular_error_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond between = a.conjugate() * b;
  return 2.0 * std::atan2(between.vec().norm(), std::abs(between.w()));
}

void take_nearest_equivalents(FrameResult& result, const TargetSymmetry& symmetry) {
  for (Eigen::Quaterniond* estimate : {&result.rcnn, &result.cnn, &result.baseline})
    *estimate = nearest_equivalent(*estimate, result.truth, symmetry);
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
  summary.mean_deg = mean(errors_deg);
  summary.mean_standard_error_deg = mean_standard_error(errors_deg);
  summary.within_20deg = share_within(errors_deg, kWrong_deg);
  summary.within_5deg = share_within(errors_deg, 5.0);
  const std::vector<double> right(errors_deg.begin(),
                                  std::upper_bound(errors_deg.begin(), errors_deg.end(), kWrong_deg));
  summary.mean_within_20_deg = right.empty() ? kUnknown : mean(right);
  summary.mean_within_20_standard_error_deg = mean_standard_error(right);
  summary.wrong_and_valid = kUnknown;
  summary.right_and_valid = kUnknown;
  summary.error_below_3_expected = kUnknown;
  summary.expected_over_real = kUnknown;
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
  for (const FrameResult& result : last_frames_of(results, frames, estimator)) {
    errors.push_back(error_deg(result, estimator));
  }
  return errors;
}

ErrorSummary last_frame_summary(const std::vector<FrameResult>& results, std::uint32_t frames,
                                Estimator estimator) {
  ErrorSummary summary = summarise(last_frame_errors_deg(results, frames, estimator));
  if (summary.count == 0) return summary;
  std::size_t wrong = 0;
  std::size_t right = 0;
  for (const FrameResult& result : last_frames_of(results, frames, estimator)) {
    if (is_trusted(result, estimator)) ++(error_deg(result, estimator) > kWrong_deg ? wrong : right);
  }
  summary.wrong_and_valid = static_cast<double>(wrong) / static_cast<double>(summary.count);
  summary.right_and_valid = static_cast<double>(right) / static_cast<double>(summary.count);
  if (estimator != Estimator::kBaseline)
    compare_expected(last_frames_of(results, frames, estimator), estimator, summary);
  return summary;
}

double share_never_trusted(const std::vector<FrameResult>& results, std::uint32_t first) {
  std::map<std::uint32_t, bool> trusted;  // by sequence
  for (const FrameResult& result : results) {
    bool& once = trusted[result.sequence];
    once = once || (result.frame >= first && result.trusted);
  }
  if (trusted.empty()) return 0.0;
  const auto never =
      std::count_if(trusted.begin(), trusted.end(), [](const auto& sequence) { return !sequence.second; });
  return static_cast<double>(never) / static_cast<double>(trusted.size());
}

PoseSummary pose_summary(const std::vector<FrameResult>& results, std::uint32_t frame) {
  std::vector<PoseErrors> poses;
  for (const FrameResult& result : results)
    if (result.frame == frame) poses.push_back(result.pose);
  return summarise_poses(poses);
}

CommonTurn common_turn(const std::vector<FrameResult>& results, Estimator estimator) {
  constexpr std::size_t kMost = 300;  // every turn is compared with every other one
  const std::size_t count = std::min(results.size(), kMost);
  std::vector<Eigen::Quaterniond> turns;
  for (std::size_t i = 0; i < count; ++i) {
    if (has_estimate(results[i], estimator))
      turns.push_back((results[i].truth.conjugate() * estimate(results[i], estimator)).normalized());
  }
  std::size_t most = 0;
  CommonTurn common;
  for (const Eigen::Quaterniond& turn : turns) {
    const auto alike =
        static_cast<std::size_t>(std::count_if(turns.begin(), turns.end(), [&](const auto& other) {
          return angular_error_rad(turn, other) <= kRadPerDeg * kWrong_deg;
        }));
    if (alike <= most) continue;
    most = alike;
    common = {static_cast<double>(alike) / static_cast<double>(count),
              Eigen::AngleAxisd(turn.w() < 0.0 ? Eigen::Quaterniond(-turn.coeffs()) : turn)};
  }
  return common;
}

}  // namespace tumblesight::sim
