// Fits a simplified mesh to the surface that it stands for. Collapsing edges cuts corners off, so that a
// convex surface shrinks: a dish or a cylinder would be registered too near. Vertices moved outward bring its
// mean distance back to zero.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The mesh with its vertices moved so that the sum of the squared distances from `points_m`, which lie on the
// true surface, to the closest points of the mesh is smallest: three linear least squares in turn, each
// damped by a hundredth of the weight of a typical vertex. Points farther than `reach_m` belong to parts that
// the mesh has lost and do not count. Deterministic. Throws std::runtime_error if Embree refuses the mesh.
TriangleMesh fitted(TriangleMesh mesh, const std::vector<Eigen::Vector3f>& points_m, double reach_m);

}  // namespace tumblesight::sim
