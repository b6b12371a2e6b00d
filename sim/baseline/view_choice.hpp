// What both peers do around their library: the scan as a cloud near the origin, and the choice of the pose
// among several candidates.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "sim/baseline/pose_peer.hpp"
#include "sim/baseline/surface_cloud.hpp"

namespace tumblesight::sim {

// The cloud of a scan in the directions of the LRF, with the centre of the returns as its origin.
class CentredScan {
 public:
  CentredScan(const TargetScan& scan, double cell_m);

  bool is_usable() const;  // enough points for a pose
  // Thinned to `cell_m`.
  const SurfaceCloud& cloud() const { return cloud_; }
  // Thinned for ViewChoice.
  const SurfaceCloud& coarse() const { return coarse_; }
  // Towards the sensor.
  const Eigen::Vector3d& towards_sensor() const { return towards_sensor_; }
  // Whether the target at a pose shows the sensor about the side of `view`. `trf_scan` takes this cloud to
  // the TRF.
  bool could_show(const SurfaceView& view, const Eigen::Isometry3d& trf_scan) const;

 private:
  SurfaceCloud cloud_;
  SurfaceCloud coarse_;
  Eigen::Vector3d towards_sensor_;
};

// The views with their clouds thinned for ViewChoice.
std::vector<SurfaceView> coarse(std::vector<SurfaceView> views);

// Chooses the candidate with the least misfit between the scan and the view that the target would show. Both
// libraries rank their candidates by how well the scan lies on the surface alone, which knows nothing of
// surface that the scan should show and does not.
class ViewChoice {
 public:
  // `views` are coarse ones. Both must outlive this object.
  ViewChoice(const std::vector<SurfaceView>& views, const CentredScan& scan);

  // `trf_scan` takes the centred cloud to the TRF.
  void offer(const Eigen::Isometry3d& trf_scan);
  // Not valid if nothing was offered.
  const PosePeer::Result& best() const { return best_; }

 private:
  const std::vector<SurfaceView>& views_;
  const CentredScan& scan_;
  PosePeer::Result best_;
  double least_misfit_m2_ = std::numeric_limits<double>::max();
};

}  // namespace tumblesight::sim
