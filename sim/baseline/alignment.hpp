// Alignment: registration of a scan with the target's surface from an approximate pose (iterative closest
// points, ICP).
#pragma once

#include <Eigen/Geometry>

#include "sim/baseline/silhouette.hpp"
#include "sim/baseline/target_scan.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

struct TargetPose {
  Eigen::Quaterniond q_lrf_trf;
  Eigen::Vector3d origin_lrf_m;  // origin of the TRF
};

enum class AlignmentPairs {
  kRangesAndSilhouette,
  kRangesOnly,  // as in textbook ICP, which uses points only; residual_m includes silhouettes in both cases
};

// Iterates: renders the surface that is visible from the current pose, pairs the scan with it and moves the
// pose by a damped Gauss-Newton step. There are two kinds of pairs, weighted by the sensor's accuracy:
//   along a ray: the measured and the rendered point (point to plane), sigma = the range noise;
//   across the rays: a rendered and the nearest measured point of the silhouette, sigma = one ray spacing.
class Alignment {
 public:
  // `lidar` renders the target and must outlive this object. `swath_m`: of its renderings (sim::swath_m).
  Alignment(const FlashLidar& lidar, double swath_m, AlignmentPairs pairs)
      : lidar_(lidar), swath_m_(swath_m), pairs_(pairs) {}

  // At most `iterations` steps on renderings of rays x rays; stops earlier when the pose has converged.
  TargetPose refine(const TargetScan& scan, const SilhouetteField& silhouette, TargetPose pose, int rays,
                    int iterations) const;

  // Root mean square of the difference between measured and rendered range over all rays that hit the target
  // in either. A difference is limited to 3 sigma of the range noise; it counts as 3 sigma where only one of
  // them hits.
  double residual_m(const TargetScan& scan, const TargetPose& pose, int rays) const;

 private:
  const FlashLidar& lidar_;
  double swath_m_;
  AlignmentPairs pairs_;
};

}  // namespace tumblesight::sim
