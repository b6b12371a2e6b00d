// Measures of a mesh, shared by the tests of sim/world/target.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

double area_m2(const TriangleMesh& mesh);
// Volume of a closed mesh that is star-shaped about `inside`; the winding does not matter.
double volume_m3(const TriangleMesh& mesh, const Eigen::Vector3d& inside);
Eigen::AlignedBox3f bounding_box(const TriangleMesh& mesh);
// Share of the triangles' edges (by position) that belong to exactly two triangles.
double closed_edge_share(const TriangleMesh& mesh);
// Heights at which a line along z through (x, y) meets the surface, in ascending order. A point on an edge
// may count twice.
std::vector<float> crossings_z_m(const TriangleMesh& mesh, float x, float y);
// Largest reach of the vertices that satisfy `belongs` along an axis (unit vector); -infinity without any.
float reach_m(const TriangleMesh& mesh, const Eigen::Vector3f& axis,
              const std::function<bool(const Eigen::Vector3f&)>& belongs);
// About `count` points evenly distributed over the surface, the same in every call.
std::vector<Eigen::Vector3f> surface_points(const TriangleMesh& mesh, int count);
// Mean distance of the points to the surface.
double mean_distance_m(const std::vector<Eigen::Vector3f>& points, const TriangleMesh& mesh);

// Whether all vertices are finite and every triangle has an area.
bool is_sound(const TriangleMesh& mesh);
// Mean distance between the surface and itself after a rotation about z.
double moved_by_turn_m(const TriangleMesh& mesh, float angle_rad);

}  // namespace tumblesight::sim
