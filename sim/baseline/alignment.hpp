// Alignment: registers a scan with the target's surface, from an approximate pose (iterated closest points).
#pragma once

#include <Eigen/Geometry>

#include "sim/baseline/outline.hpp"
#include "sim/baseline/target_scan.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

struct TargetPose {
  Eigen::Quaterniond q_lrf_trf;
  Eigen::Vector3d origin_lrf_m;  // of the TRF
};

enum class AlignmentPairs {
  kRangesAndOutline,
  kRangesOnly,  // as in textbook ICP, which knows points only; silhouettes count in residual_m still
};

// Renders the surface that is visible from the current pose, pairs the scan with it and moves the pose by a
// damped Gauss-Newton step, over again. Two kinds of pairs, each weighted by what the sensor knows of it:
//   along a ray, the measured and the rendered point (point to plane), sigma = the range noise;
//   across the rays, a point of the rendered outline and the measured outline next to it, sigma = one ray.
class Alignment {
 public:
  // `lidar` renders the target and must outlive this; swath_m: of its renderings (sim::swath_m).
  Alignment(const FlashLidar& lidar, double swath_m, AlignmentPairs pairs)
      : lidar_(lidar), swath_m_(swath_m), pairs_(pairs) {}

  // At most `iterations` steps on renderings of rays x rays; fewer once they no longer move the pose.
  TargetPose refine(const TargetScan& scan, const OutlineField& outline, TargetPose pose, int rays,
                    int iterations) const;

  // Root mean square of range minus rendered range over all rays that one or the other sees hit the target.
  // It counts as 3 sigma of the range noise where it is larger and where only one of them hits.
  double residual_m(const TargetScan& scan, const TargetPose& pose, int rays) const;

 private:
  const FlashLidar& lidar_;
  double swath_m_;
  AlignmentPairs pairs_;
};

}  // namespace tumblesight::sim
