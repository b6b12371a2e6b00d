// TargetScan: what one frame says about the target, ray by ray, with what is not the target set apart.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/sensor/range_grid.hpp"
#include "sim/world/sensor/range_noise.hpp"

namespace tumblesight::sim {

enum class RayKind : std::uint8_t {
  kMiss,     // passes the target
  kReturn,   // hits it, at a known range
  kLost,     // no return, but surrounded by returns: a dropout, most likely
  kBlocked,  // ends on the chaser itself: nothing is known beyond
};

// Square, row by row from the top left, as gnc::RangeImage; at least gnc::kMinReturns rays are kReturn.
struct TargetScan {
  int rays = 0;  // to a side
  double tan_half_fov = 0.0;
  std::vector<RayKind> kind;
  std::vector<float> range_m;   // of kReturn; else 0
  Eigen::Vector3d towards;      // LRF, unit: to the centroid of the returns as seen from the sensor
  double centre_range_m = 0.0;  // mean of the returns' ranges, outliers left out

  double slope(int index) const { return tan_half_fov * ((2.0 * index + 1.0) / rays - 1.0); }
  Eigen::Vector3d direction(int ray) const;  // LRF, unit
  bool on_target(int ray) const { return kind[ray] == RayKind::kReturn || kind[ray] == RayKind::kLost; }
};

// Nothing when the frame's rays or field of view are out of the sensor's limits or too few rays return.
std::optional<TargetScan> scan_of(const gnc::RangeImage& frame);
// The same of a rendered frame, to be compared with those of measured ones.
std::optional<TargetScan> scan_of(const RangeGrid& grid);

}  // namespace tumblesight::sim
