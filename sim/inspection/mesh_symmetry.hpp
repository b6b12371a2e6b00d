// Which rotations map the outer surface of a mesh onto itself, and how nearly. A rotation that does leaves
// attitudes that no frame can tell apart.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

inline constexpr std::array<int, 5> kFolds{2, 3, 4, 5, 6};

struct SymmetryAxis {
  Eigen::Vector3d axis_trf = Eigen::Vector3d::UnitZ();  // unit; its largest component is positive
  // After 1/n of a turn about this axis, for the n of kFolds: mean distance of the surface from where it was.
  std::array<double, kFolds.size()> moved_m{};
  double any_turn_m = 0.0;  // the largest mean distance after turns by angles that are no fold
};

struct SurfaceSymmetry {
  // The first three are the principal axes, in the order of the extent along them, the largest first. The
  // three most symmetric others follow where principal axes are not determined, because the extents along
  // them are alike.
  std::vector<SymmetryAxis> axes;
  Eigen::Vector3d extent_m = Eigen::Vector3d::Zero();  // standard deviation of the surface along the three
  Eigen::Vector3d centre_trf_m = Eigen::Vector3d::Zero();
};

// `points_trf_m`: of the outer surface (outside_views.hpp), at least 3. The axes run through their mean.
// Assumptions: a symmetry of the whole outer surface, of which a sensor sees one side; parts that move are
// where the mesh has them.
SurfaceSymmetry symmetry_of(const TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& points_trf_m);

}  // namespace tumblesight::sim
