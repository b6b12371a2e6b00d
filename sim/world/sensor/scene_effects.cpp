// Effects of what else is in view: behind, beside and around the target.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kBackgroundDistance_m = 30.0;  // behind the target's origin
constexpr double kSwathPerRadius = 2.1;         // of a frame that is fitted to the target
constexpr double kPlumeRadius = 1.5;            // over the target's radius

// Along the ray `index`, unit length, LRF.
Eigen::Vector3d direction_of(const RangeGrid& grid, std::size_t index) {
  const auto rays = static_cast<std::size_t>(grid.rays);
  return Eigen::Vector3d(grid.slope(static_cast<int>(index % rays)), 1.0,
                         -grid.slope(static_cast<int>(index / rays)))
      .normalized();
}

Eigen::Vector3d target_lrf_m(const Flash& flash) {
  const Eigen::Vector2d offset_m = flash.truth.offset_swaths * flash.swath_m;
  return {offset_m.x(), flash.truth.range_m, offset_m.y()};
}

// Range at which a ray from the sensor enters a sphere; infinity if it passes it.
double range_of_sphere(const Eigen::Vector3d& direction, const Eigen::Vector3d& centre_m, double radius_m) {
  const double along_m = direction.dot(centre_m);
  const double square = radius_m * radius_m - (centre_m.squaredNorm() - along_m * along_m);
  if (square < 0.0 || along_m <= 0.0) return std::numeric_limits<double>::infinity();
  return along_m - std::sqrt(square);
}

}  // namespace

// A flat surface across the boresight, 30 m behind the target, fills the given share of the field of view on
// one side of a straight edge: the Earth's limb, or a larger craft. It is seen where no other surface is. The
// edge stays through a sequence. Limit: the surface has no depth of its own.
void add_background(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid) {
  const double side_rad = random.sequence.uniform(0.0, 2.0 * kPi);
  const auto along = [&](std::size_t index) {
    const Eigen::Vector3d d = direction_of(grid, index);
    return (std::cos(side_rad) * d.x() + std::sin(side_rad) * d.z()) / d.y();
  };
  const std::size_t count = grid.range_m.size();
  std::vector<double> ordered(count);
  for (std::size_t i = 0; i < count; ++i) ordered[i] = along(i);
  const auto outside = static_cast<std::size_t>(std::lround((1.0 - strength) * static_cast<double>(count)));
  if (outside >= count) return;
  std::nth_element(ordered.begin(), ordered.begin() + static_cast<std::ptrdiff_t>(outside), ordered.end());
  const double edge = ordered[outside];
  const double depth_m = flash.truth.range_m + kBackgroundDistance_m;
  for (std::size_t i = 0; i < count; ++i) {
    if (std::isfinite(grid.range_m[i]) || along(i) < edge) continue;
    grid.range_m[i] = depth_m / direction_of(grid, i).y();
  }
}

// A sphere of the given diameter in metres flies beside, in front of or behind the target: its centre is
// drawn within the target's swath, and up to half a swath nearer or farther, and stays there through a
// sequence.
void add_debris(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid) {
  const double right = random.sequence.uniform(-0.5, 0.5);
  const double up = random.sequence.uniform(-0.5, 0.5);
  const double deeper = random.sequence.uniform(-0.5, 0.5);
  const Eigen::Vector3d centre_m(right * flash.swath_m, flash.truth.range_m + deeper * flash.swath_m,
                                 up * flash.swath_m);
  for (std::size_t i = 0; i < grid.range_m.size(); ++i) {
    const double range_m = range_of_sphere(direction_of(grid, i), centre_m, 0.5 * strength);
    grid.range_m[i] = std::min(grid.range_m[i], range_m);
  }
}

// Particles of a plume: each ray through the sphere of 1.5 radii around the target meets one with the given
// probability, at a place drawn uniformly along its way through that sphere. What is nearer, particle or
// surface, gives the return. New in every frame.
void add_plume(double strength, const Flash& flash, EffectRandom& random, RangeGrid& grid) {
  const double radius_m = kPlumeRadius * flash.swath_m / kSwathPerRadius;
  const Eigen::Vector3d centre_m = target_lrf_m(flash);
  for (std::size_t i = 0; i < grid.range_m.size(); ++i) {
    if (random.frame.uniform() >= strength) continue;
    const Eigen::Vector3d direction = direction_of(grid, i);
    const double near_m = range_of_sphere(direction, centre_m, radius_m);
    if (!std::isfinite(near_m)) continue;
    const double far_m = 2.0 * direction.dot(centre_m) - near_m;
    const double range_m = random.frame.uniform(std::max(0.0, near_m), far_m);
    grid.range_m[i] = std::min(grid.range_m[i], range_m);
  }
}

}  // namespace tumblesight::sim
