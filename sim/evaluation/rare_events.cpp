#include "sim/evaluation/rare_events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kTail = 0.025;
constexpr double kPoseWrong_deg = 5.0;

// P(X <= count) of a binomial distribution, for a count below the mean: the terms fall from `count` down.
double lower_tail(std::size_t count, std::size_t of, double share) {
  const double n = static_cast<double>(of);
  const double k = static_cast<double>(count);
  const double log_first = std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                           k * std::log(share) + (n - k) * std::log1p(-share);
  double sum = 0.0;
  double term = 1.0;
  for (double j = k; term > 1e-17 * sum; j -= 1.0) {
    sum += term;
    term *= j * (1.0 - share) / ((n - j + 1.0) * share);
  }
  return std::exp(log_first) * sum;
}

// The share above the observed one at which `count` or fewer have the probability kTail.
double upper_bound(std::size_t count, std::size_t of) {
  if (count >= of) return 1.0;
  double low = static_cast<double>(count) / static_cast<double>(of);
  double high = 1.0;
  for (int step = 0; step < 100 && low < high; ++step) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (lower_tail(count, of, middle) > kTail ? low : high) = middle;
  }
  return high;
}

bool pose_is_off(const FrameResult& result, double limit_deg) {
  return result.pose.turn_deg > limit_deg;
}

WorstSequence worst_of(const FrameResult& result, bool has_poses) {
  WorstSequence one;
  one.sequence = result.sequence;
  one.valid = result.trusted;
  one.error_deg = error_deg(result, Estimator::kRcnn);
  one.pose_deg = has_poses ? result.pose.turn_deg : std::nan("");
  one.pose_verified = result.pose.verified;
  one.range_m = result.range_m;
  one.rate_deg_s = kDegPerRad * result.rate_rad_s;
  return one;
}

// What is wrong and vouched for is worse than what is only wrong.
int badness_of(const WorstSequence& one) {
  if (one.pose_verified && one.pose_deg > kPoseWrong_deg) return 3;
  if (one.valid && one.error_deg > kWrong_deg) return 2;
  return one.pose_deg > kWrong_deg ? 1 : 0;
}

// Two significant digits, without an exponent.
std::string percent(double share) {
  if (share <= 0.0) return "0";
  const int digits = std::max(0, 1 - static_cast<int>(std::floor(std::log10(100.0 * share))));
  return fmt::format("{:.{}f}", 100.0 * share, digits);
}

}  // namespace

ShareBounds share_bounds_95(std::size_t count, std::size_t of) {
  if (of == 0) return {};
  return {1.0 - upper_bound(of - count, of), upper_bound(count, of)};
}

const std::vector<RareEventRow>& rare_event_table() {
  static const std::vector<RareEventRow> table{
      {RareEvent::kWrong, "wrong", "wrong: over 20°",
       [](const FrameResult& result) { return error_deg(result, Estimator::kRcnn) > kWrong_deg; }, false},
      {RareEvent::kWrongAndValid, "wrong_and_valid", "wrong and valid",
       [](const FrameResult& result) {
         return result.trusted && error_deg(result, Estimator::kRcnn) > kWrong_deg;
       },
       false},
      {RareEvent::kPoseWrong, "pose_wrong", "pose over 20°",
       [](const FrameResult& result) { return pose_is_off(result, kWrong_deg); }, true},
      {RareEvent::kPoseVerifiedWrong, "pose_verified_wrong", "pose verified and over 5°",
       [](const FrameResult& result) { return result.pose.verified && pose_is_off(result, kPoseWrong_deg); },
       true}};
  return table;
}

RareEvents rare_events(const std::vector<FrameResult>& last) {
  RareEvents events;
  events.of = last.size();
  for (const RareEventRow& row : rare_event_table())
    events.counts.push_back(static_cast<std::size_t>(std::count_if(last.begin(), last.end(), row.happened)));
  events.has_poses =
      std::any_of(last.begin(), last.end(), [](const FrameResult& result) { return result.pose.known; });
  for (const FrameResult& result : last) events.worst.push_back(worst_of(result, events.has_poses));
  const auto worse = [](const WorstSequence& a, const WorstSequence& b) {
    return std::make_tuple(badness_of(b), b.error_deg, a.sequence) <
           std::make_tuple(badness_of(a), a.error_deg, b.sequence);
  };
  const std::size_t kept = std::min(events.worst.size(), kWorstSequences);
  std::partial_sort(events.worst.begin(), events.worst.begin() + static_cast<std::ptrdiff_t>(kept),
                    events.worst.end(), worse);
  events.worst.resize(kept);
  return events;
}

std::string count_text(std::size_t count, std::size_t of) {
  if (of == 0) return "-";
  const ShareBounds bounds = share_bounds_95(count, of);
  return fmt::format("{} ({} to {} %)", count, percent(bounds.low), percent(bounds.high));
}

}  // namespace tumblesight::sim
