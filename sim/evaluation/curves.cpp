#include "sim/evaluation/curves.hpp"

#include <algorithm>

#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

std::vector<double> even_edges(double low, double high, int bins) {
  std::vector<double> edges;
  for (int i = 0; i <= bins; ++i) edges.push_back(low + (high - low) * i / bins);
  return edges;
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

}  // namespace tumblesight::sim
