#include "sim/evaluation/curves.hpp"

#include <algorithm>
#include <cmath>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

std::vector<double> even_edges(double low, double high, int bins) {
  std::vector<double> edges;
  for (int i = 0; i <= bins; ++i) edges.push_back(low + (high - low) * i / bins);
  return edges;
}

constexpr double kLogSpan = 20.0;  // from this ratio of the ends on, the steps are factors
constexpr double kRatio = 1.05;
constexpr double kShareOfRange = 0.01;

double with_three_digits(double value) {
  if (value == 0.0) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  // A division by a power of ten is exact where the product with its inverse is not.
  return unit < 1.0 ? std::round(value / unit) / std::round(1.0 / unit) : std::round(value / unit) * unit;
}

// Halves the distance of two strengths on the scale of one side.
class Bisection {
 public:
  Bisection(double from, double to, bool whole) : range_(std::abs(to - from)), whole_(whole) {
    factors_ = !whole && from > 0.0 && to / from > kLogSpan;
  }

  bool is_close(double a, double b) const {
    if (whole_) return std::abs(a - b) <= 1.0;
    return factors_ ? std::max(a, b) <= kRatio * std::min(a, b) : std::abs(a - b) <= kShareOfRange * range_;
  }
  double middle(double a, double b) const {
    const double middle = factors_ ? std::sqrt(a * b) : 0.5 * (a + b);
    return whole_ ? std::floor(middle) : with_three_digits(middle);
  }

 private:
  double range_;
  bool whole_;
  bool factors_ = false;
};

EffectLimit effect_limit(double from, double to, bool whole,
                         const std::function<double(double)>& within_20deg) {
  EffectLimit limit;
  limit.from = from;
  limit.to = to;
  const auto holds = [&](double strength) {
    limit.trials.push_back({strength, within_20deg(strength)});
    return limit.trials.back().within_20deg >= kEffectBar;
  };
  const bool from_holds = holds(from), to_holds = holds(to);
  if (from_holds || to_holds) limit.holds_at = to_holds ? to : from;
  if (!from_holds || !to_holds) limit.fails_at = from_holds ? to : from;
  if (from_holds == to_holds) return limit;
  const Bisection bisection(from, to, whole);
  while (!bisection.is_close(*limit.holds_at, *limit.fails_at)) {
    const double middle = bisection.middle(*limit.holds_at, *limit.fails_at);
    (holds(middle) ? limit.holds_at : limit.fails_at) = middle;
  }
  return limit;
}

}  // namespace

CurvePoint curve_point(double at, const std::vector<FrameResult>& results) {
  std::vector<double> rcnn;
  std::vector<double> cnn;
  for (const FrameResult& result : results) {
    rcnn.push_back(error_deg(result, Estimator::kRcnn));
    cnn.push_back(error_deg(result, Estimator::kCnn));
  }
  return {at, summarise(std::move(rcnn)), summarise(std::move(cnn))};
}

Curve errors_by_frame(const std::vector<FrameResult>& results, std::uint32_t frames) {
  std::vector<std::vector<FrameResult>> of_frame(frames);
  for (const FrameResult& result : results) {
    const bool counts = result.valid || result.owed;
    if (result.frame < frames && counts) of_frame[result.frame].push_back(result);
  }
  Curve curve;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    curve.push_back(curve_point(frame + 1.0, of_frame[frame]));
  }
  return curve;
}

Curve binned(const std::vector<FrameResult>& results,
             const std::function<double(const FrameResult&)>& value_of, const std::vector<double>& edges) {
  if (edges.size() < 2) return {};
  std::vector<std::vector<FrameResult>> bins(edges.size() - 1);
  for (const FrameResult& result : results) {
    const double value = value_of(result);
    if (!(value >= edges.front() && value <= edges.back())) continue;
    const auto above = std::upper_bound(edges.begin(), edges.end(), value) - edges.begin();
    bins[std::min(static_cast<std::size_t>(above) - 1, bins.size() - 1)].push_back(result);
  }
  Curve curve;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    curve.push_back(curve_point(0.5 * (edges[i] + edges[i + 1]), bins[i]));
  }
  return curve;
}

Curve errors_by_range(const std::vector<FrameResult>& last, const RangeLimits& ranges) {
  return binned(
      last, [](const FrameResult& result) { return result.range_m; },
      even_edges(ranges.nearest_m, ranges.farthest_m, 8));
}

Curve errors_by_rate(const std::vector<FrameResult>& last) {
  return binned(
      last, [](const FrameResult& result) { return kDegPerRad * result.rate_rad_s; },
      even_edges(0.0, 20.0, 8));
}

double flatness(const Curve& curve, std::size_t min_count) {
  double smallest = 0.0;
  double largest = 0.0;
  int used = 0;
  for (const CurvePoint& point : curve) {
    if (point.rcnn.count < min_count) continue;
    smallest = used == 0 ? point.rcnn.mean_deg : std::min(smallest, point.rcnn.mean_deg);
    largest = std::max(largest, point.rcnn.mean_deg);
    ++used;
  }
  return used < 2 || smallest <= 0.0 ? 0.0 : largest / smallest;
}

const std::vector<double>& histogram_limits_deg() {
  static const std::vector<double> limits{1, 2, 5, 10, 20, 45, 90, 180};
  return limits;
}

std::vector<double> histogram(const std::vector<double>& errors_deg) {
  const std::vector<double>& limits = histogram_limits_deg();
  std::vector<double> shares(limits.size(), 0.0);
  for (const double error : errors_deg) {
    const auto bin = std::lower_bound(limits.begin(), limits.end() - 1, error) - limits.begin();
    shares[static_cast<std::size_t>(bin)] += 1.0 / static_cast<double>(errors_deg.size());
  }
  return shares;
}

std::vector<EffectLimit> effect_limits(const EffectRow& row,
                                       const std::function<double(double)>& within_20deg) {
  const bool whole = must_be_whole(row);
  if (row.lowest >= 0.0) return {effect_limit(row.lowest, row.highest, whole, within_20deg)};
  return {effect_limit(0.0, row.lowest, whole, within_20deg),
          effect_limit(0.0, row.highest, whole, within_20deg)};
}

}  // namespace tumblesight::sim
