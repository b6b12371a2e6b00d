// TargetScan: one frame with its rays classified: target, dropout, blocked by the chaser, past the target.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/sensor/range_grid.hpp"
#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {

enum class RayKind : std::uint8_t {
  kMiss,     // no return: passes the target
  kReturn,   // hits the target at a known range
  kLost,     // no return, but surrounded by returns: probably a dropout
  kBlocked,  // ends on the chaser itself: nothing is known behind it
};

// Square, row by row from the top left, as in gnc::RangeImage. At least gnc::kMinReturns rays are kReturn.
struct TargetScan {
  int rays = 0;  // per side
  double tan_half_fov = 0.0;
  std::vector<RayKind> kind;
  std::vector<float> range_m;   // 0 unless kReturn
  Eigen::Vector3d towards;      // LRF, unit vector from the sensor to the centroid of the returns
  double centre_range_m = 0.0;  // mean range of the returns without outliers

  double slope(int index) const { return tan_half_fov * ((2.0 * index + 1.0) / rays - 1.0); }
  Eigen::Vector3d direction(int ray) const;  // LRF, unit vector
  bool on_target(int ray) const { return kind[ray] == RayKind::kReturn || kind[ray] == RayKind::kLost; }
};

// Empty if the rays or the field of view of the frame are outside the sensor's limits or if there are too few
// returns.
std::optional<TargetScan> scan_of(const gnc::RangeImage& frame);
// The same for a rendered frame, for comparison with measured ones.
std::optional<TargetScan> scan_of(const RangeGrid& grid);

}  // namespace tumblesight::sim
