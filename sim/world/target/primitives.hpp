// Primitives: the surfaces that a spacecraft is composed of: caps, bands, boxes, prisms, surfaces of
// revolution, tubes.
//
// Lengths are in metres, coordinates in the frame in which the part is built; `placed` moves a part into
// another frame. Faces are single sheets that reflect on both sides, so that the winding has no meaning.
// Every function that makes a surface throws std::invalid_argument if its loop has too few points or its size
// is not positive.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

using Loop = std::vector<Eigen::Vector3f>;     // a closed polygon in space, first point not repeated
using Outline = std::vector<Eigen::Vector2f>;  // a polygon in a plane

// Adds the vertices and triangles of `part` to `whole`; the name of `whole` does not change.
void append(TriangleMesh& whole, const TriangleMesh& part);
// The part, marked as a solar panel.
TriangleMesh as_panel(TriangleMesh part);
// The part with each vertex p moved to pose * p.
TriangleMesh placed(TriangleMesh part, const Eigen::Isometry3f& pose);
// The part, reflected in the plane through the origin across the axis (0 = x, 1 = y, 2 = z).
TriangleMesh mirrored(TriangleMesh part, int axis);
// The part and its mirror image.
TriangleMesh with_mirror_image(const TriangleMesh& part, int axis);

// The polygon enclosed by a loop, which must be convex and planar.
TriangleMesh cap(const Loop& loop);
// The strip between two loops of equally many points, point i of one joined to point i of the other.
TriangleMesh band(const Loop& from, const Loop& to);
// The open strip between two chains of equally many points, at least two.
TriangleMesh strip(const Loop& from, const Loop& to);
// The closed surface between two loops of equally many points: two caps and a band.
TriangleMesh loft(const Loop& from, const Loop& to);

// The outline, point by point, at height z.
Loop loop_at(const Outline& outline, float z);
// `sides` corners at `radius` around the z axis, the first at angle `first_corner_rad` from +x.
Outline regular_polygon(int sides, float radius, float first_corner_rad);

// A box centred at the origin with its edges along the axes.
TriangleMesh box(const Eigen::Vector3f& size);
// A box with its edges along the axes, given by two opposite corners, the smaller coordinates first.
TriangleMesh box_between(const Eigen::Vector3f& min, const Eigen::Vector3f& max);
// A prism on a convex outline in the x-y plane, from z_from to z_to.
TriangleMesh prism(const Outline& outline, float z_from, float z_to);
// A prism whose cross-section is a convex profile in the vertical plane through the z axis at `heading_rad`
// from +x. A profile point is (u, z), u being the distance from the z axis along the heading; the prism runs
// from v_from to v_to along the horizontal to the left of the heading.
TriangleMesh upright_prism(const Outline& profile_uz, float heading_rad, float v_from, float v_to);
// A closed frustum of a regular pyramid on the z axis; radii are those of the corners.
TriangleMesh frustum(int sides, float radius_from, float radius_to, float z_from, float z_to,
                     float first_corner_rad = 0.0F);
// The surface of revolution of a profile of points (r, z), r >= 0, about the z axis in `sides` steps. Open
// where the profile ends off the axis, closed where it ends at r = 0.
TriangleMesh revolve(const Outline& profile_rz, int sides);
// A closed cylinder (or cone frustum) between two points.
TriangleMesh tube(const Eigen::Vector3f& from, const Eigen::Vector3f& to, float radius_from, float radius_to,
                  int sides);
// Pose of a frame whose z axis points along `axis` and whose origin lies at `origin`.
Eigen::Isometry3f frame_along(const Eigen::Vector3f& origin, const Eigen::Vector3f& axis);
// Pose of a frame at `origin` whose x axis points along `x` and whose y axis is `y`, made perpendicular to x.
Eigen::Isometry3f frame_at(const Eigen::Vector3f& origin, const Eigen::Vector3f& x, const Eigen::Vector3f& y);
// Pose of a frame at the origin, rotated about z.
Eigen::Isometry3f turned(float angle_rad);

}  // namespace tumblesight::sim
