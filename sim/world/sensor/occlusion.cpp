#include "sim/world/sensor/occlusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tumblesight::sim {
namespace {

constexpr double kArmSlimness = 0.25;  // half its width over its length inside the target's outline

// Unit vector towards the side from which the occluder comes. The second axis is a quarter turn further.
struct Axes {
  double along_x;
  double along_y;
};

// The smallest of the values with at least this share of the values (and at least one) at or below it.
// Reorders the values.
double quantile(std::vector<double>& values, double share) {
  const auto count = static_cast<long>(values.size());
  const long wanted = std::clamp(std::lround(share * static_cast<double>(count)), 1L, count);
  const auto at = values.begin() + (wanted - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Calls visit(ray index, along, across) for every ray.
template <typename Visitor>
void for_each_ray(const RangeGrid& grid, const Axes& axes, Visitor&& visit) {
  for (int row = 0; row < grid.rays; ++row) {
    const double y = -grid.slope(row);
    for (int column = 0; column < grid.rays; ++column) {
      const double x = grid.slope(column);
      visit(row * grid.rays + column, axes.along_x * x + axes.along_y * y,
            axes.along_x * y - axes.along_y * x);
    }
  }
}

// Size at which the shape just reaches a ray: each shape is the set of rays with required_size <= its size.
double required_size(OccluderShape shape, double from_side, double from_axis) {
  switch (shape) {
    case OccluderShape::kArm:
      return std::max(from_side, std::abs(from_axis) / kArmSlimness);
    case OccluderShape::kMast:
      return std::abs(from_axis);
    case OccluderShape::kPanelEdge:
      return from_side;
    case OccluderShape::kNone:
      break;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

void occlude(const Occluder& occluder, RangeGrid& grid) {
  if (occluder.shape == OccluderShape::kNone || !(occluder.hidden_share > 0.0)) return;
  const Axes axes{std::cos(occluder.side_rad), std::sin(occluder.side_rad)};
  std::vector<double> along, across;  // of the rays that hit the target
  for_each_ray(grid, axes, [&](int ray, double a, double c) {
    if (!std::isfinite(grid.range_m[ray])) return;
    along.push_back(a);
    across.push_back(c);
  });
  if (along.empty()) return;

  const double side = *std::max_element(along.begin(), along.end());
  const double axis = quantile(across, occluder.across);
  std::vector<double> sizes;
  for_each_ray(grid, axes, [&](int ray, double a, double c) {
    if (std::isfinite(grid.range_m[ray])) sizes.push_back(required_size(occluder.shape, side - a, c - axis));
  });
  const double size = quantile(sizes, occluder.hidden_share);
  for_each_ray(grid, axes, [&](int ray, double a, double c) {
    if (required_size(occluder.shape, side - a, c - axis) > size) return;
    const double x = grid.slope(ray % grid.rays);
    const double y = grid.slope(ray / grid.rays);
    grid.range_m[ray] = occluder.distance_m * std::sqrt(1.0 + x * x + y * y);
  });
}

}  // namespace tumblesight::sim
