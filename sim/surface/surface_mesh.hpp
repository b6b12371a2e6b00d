// The target's surface as triangles for the model image (gnc/surface/surface_mesh.hpp), simplified from
// its mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// A section that gnc::SurfaceMesh finds sound. `radius_m`: the target radius of the image's header;
// coordinates beyond it are limited to it.
//
// 1. Vertices within 1 mm of each other become one.
// 2. Triangles that no ray of 150 views from outside meets are left out (outside_views.hpp). Triangles that
//    are too narrow for the rays are kept.
// 3. Edges are collapsed within an error of 5 mm, or 1/500 of the mesh's radius if that is less. As long as
//    the result exceeds a limit of gnc::SurfaceMesh, the error is doubled. From 16 times the first error on,
//    vertices closer together than a quarter of the error become one. This ends with every mesh, even with
//    one whose triangles share no edges.
// 4. An edge is listed unless the two triangles on it lie within 2 degrees of a plane: a plane's inner edges
//    are on no silhouette. If an edge has more than two triangles, the two that are farthest from lying
//    folded onto each other count.
// 5. A triangle is listed with its corners counterclockwise as seen from outside, which is found by the same
//    views. A triangle is listed twice, once for each side, if each side gets at least 1 % of its rays, as
//    those of a sheet do, or if it is too narrow for the rays. If the list exceeds its limit, the error is
//    doubled as in step 3.
//
// The error that the header states is measured: the largest distance, rounded up to a millimetre, of a point
// of either surface from the other surface. The points are where the rays of the views meet it (about
// 100,000), corners and middles of edges. A part between them that is smaller than their spacing can be
// farther away.
//
// Deterministic. Throws std::invalid_argument for a radius that is not positive and for a mesh that shows no
// surface, std::runtime_error in a build without meshoptimizer.
std::vector<std::uint8_t> surface_mesh_section(const TriangleMesh& mesh, double radius_m);

}  // namespace tumblesight::sim
