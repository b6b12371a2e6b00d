// The target's surface for the model image (gnc/surface/surface_model.hpp), sampled from its mesh.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gnc/surface/surface_model.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The section of a model image: SurfaceModel::kBytes. `radius_m`: the target radius of the image's header;
// coordinates beyond it are limited to it.
//
// Random points on the triangles, uniform over the area, on both sides. Those that two of 150 directions see,
// at an incidence below 60 degrees, stay: the mesh need not be watertight, and nothing inside it counts. Of
// these, in random order, a point is taken if no other one taken is within the spacing on a surface within 60
// degrees of its direction. The spacing is the smallest that leaves at most SurfaceModel::kMaxPoints.
// Deterministic. Throws std::invalid_argument for a mesh without triangles.
std::vector<std::uint8_t> surface_section(const TriangleMesh& mesh, double radius_m);

// The share of the points of one surface that are farther than a tenth of the radius from all points of the
// other after its turn by `turn`; the larger share of both ways. 0 if one of them has no points.
double unlike_share(const gnc::SurfaceModel& surface, const gnc::SurfaceModel& other,
                    const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity());

}  // namespace tumblesight::sim
