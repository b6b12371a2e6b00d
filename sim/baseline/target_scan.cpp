#include "sim/baseline/target_scan.hpp"

#include <algorithm>
#include <cmath>

#include "gnc/lidar/depth_image.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kMinRays = 16;
constexpr int kNeighboursOfADropout = 5;  // of 8: the count of a ray lost at a straight edge
constexpr double kOutlierWindow_m =
    7.0;  // radius of the largest target: no return is farther from the centre

void mark_dropouts(TargetScan& scan) {
  const std::vector<RayKind> seen = scan.kind;
  for (int row = 1; row + 1 < scan.rays; ++row) {
    for (int column = 1; column + 1 < scan.rays; ++column) {
      const int ray = row * scan.rays + column;
      if (seen[ray] != RayKind::kMiss) continue;
      int returns = 0;
      for (int step_row = -1; step_row <= 1; ++step_row) {
        for (int step_column = -1; step_column <= 1; ++step_column) {
          returns += seen[ray + step_row * scan.rays + step_column] == RayKind::kReturn ? 1 : 0;
        }
      }
      if (returns >= kNeighboursOfADropout) scan.kind[ray] = RayKind::kLost;
    }
  }
}

// Direction and range of the centre of the returns. The mean range is not biased by noise.
void find_centre(TargetScan& scan) {
  std::vector<float> ranges;
  double right = 0.0, up = 0.0;
  for (int ray = 0; ray < scan.rays * scan.rays; ++ray) {
    if (scan.kind[ray] != RayKind::kReturn) continue;
    ranges.push_back(scan.range_m[ray]);
    right += scan.slope(ray % scan.rays);
    up -= scan.slope(ray / scan.rays);
  }
  const auto count = static_cast<double>(ranges.size());
  scan.towards = Eigen::Vector3d(right / count, 1.0, up / count).normalized();

  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  const double median_m = *middle;
  const double window_m = kOutlierWindow_m + 3.0 * range_sigma_m(median_m);
  double sum_m = 0.0;
  int used = 0;
  for (const float range_m : ranges) {
    if (std::abs(range_m - median_m) > window_m) continue;
    sum_m += range_m;
    ++used;
  }
  scan.centre_range_m = sum_m / used;
}

template <typename RangeOf>
std::optional<TargetScan> scan_of_rays(int rays, double tan_half_fov, const RangeOf& range_of) {
  TargetScan scan;
  scan.rays = rays;
  scan.tan_half_fov = tan_half_fov;
  scan.kind.assign(static_cast<std::size_t>(rays * rays), RayKind::kMiss);
  scan.range_m.assign(scan.kind.size(), 0.0F);
  int returns = 0;
  for (int ray = 0; ray < rays * rays; ++ray) {
    const auto range_m = static_cast<float>(range_of(ray));
    if (!(range_m > 0.0F) || range_m > gnc::kMaxRange_m) continue;
    if (range_m < gnc::kMinRange_m) {
      scan.kind[ray] = RayKind::kBlocked;
    } else {
      scan.kind[ray] = RayKind::kReturn;
      scan.range_m[ray] = range_m;
      ++returns;
    }
  }
  if (returns < gnc::kMinReturns) return std::nullopt;
  find_centre(scan);
  mark_dropouts(scan);
  return scan;
}

}  // namespace

Eigen::Vector3d TargetScan::direction(int ray) const {
  return Eigen::Vector3d(slope(ray % rays), 1.0, -slope(ray / rays)).normalized();
}

std::optional<TargetScan> scan_of(const gnc::RangeImage& frame) {
  if (frame.rays < kMinRays || frame.rays > gnc::RangeImage::kMaxRays) return std::nullopt;
  if (frame.fov_urad < gnc::kMinFov_urad || frame.fov_urad > gnc::kMaxFov_urad) return std::nullopt;
  return scan_of_rays(frame.rays, std::tan(frame.fov_urad * 0.5e-6),
                      [&](int ray) { return frame.ranges[ray] * gnc::RangeImage::kMetresPerCount; });
}

std::optional<TargetScan> scan_of(const RangeGrid& grid) {
  return scan_of_rays(grid.rays, grid.tan_half_fov, [&](int ray) { return grid.range_m[ray]; });
}

}  // namespace tumblesight::sim
