// SurfaceCloud: points on the surface of a target with their normals, as libraries for point clouds take
// them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/baseline/target_scan.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct SurfaceCloud {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;  // unit, out of the surface, one per point

  std::size_t size() const { return points_m.size(); }
};

// A target as it is seen from one side.
struct SurfaceView {
  Eigen::Vector3f towards_sensor;  // TRF, unit
  SurfaceCloud cloud;              // TRF
};

// The outer surface of a mesh: renderings without noise from `views` directions, evenly distributed over the
// sphere, with the normals of its faces. Both sides of a thin panel have points. `swath_m`: sim::swath_m.
std::vector<SurfaceView> surface_views(const TriangleMesh& mesh, double swath_m, int views);

// The returns of a scan, in the LRF. The range noise of the paper's sensor is several times the distance
// between the points, so each point lies on the plane through its neighbours in the image. How many
// neighbours those are depends on the noise, which is estimated from the scan. Lone returns are left out.
SurfaceCloud cloud_of(const TargetScan& scan);

// One point per cell of this size and main direction of the normal: the mean of the points that it replaces.
SurfaceCloud thinned(const SurfaceCloud& cloud, double cell_m);

// How badly a scan and a view agree, both in the same frame: mean square of the distance of each point to the
// nearest point of the other cloud, limited to `limit_m`. Sum of both directions.
double misfit_m2(const SurfaceCloud& a, const SurfaceCloud& b, double limit_m);

}  // namespace tumblesight::sim
