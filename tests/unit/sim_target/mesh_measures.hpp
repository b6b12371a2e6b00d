// Measures of a mesh that the tests of sim/target share.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/target/triangle_mesh.hpp"

namespace tumblesight::sim {

double area_m2(const TriangleMesh& mesh);
// Volume of a closed mesh with triangles wound either way round: star-shaped about `inside`.
double volume_m3(const TriangleMesh& mesh, const Eigen::Vector3d& inside);
Eigen::AlignedBox3f bounding_box(const TriangleMesh& mesh);
// Share of the triangles' edges (by position) that belong to exactly two triangles.
double closed_edge_share(const TriangleMesh& mesh);
// About `count` points spread evenly over the surface, the same at every call.
std::vector<Eigen::Vector3f> surface_points(const TriangleMesh& mesh, int count);
// Mean distance of the points to the nearest place of the surface.
double mean_distance_m(const std::vector<Eigen::Vector3f>& points, const TriangleMesh& mesh);

}  // namespace tumblesight::sim
