// Simplification of a mesh: fewer triangles for nearly the same surface.
//
// The mesh may be as it comes from a file: triangles that share no vertices, turned either way, repeated,
// without area. Vertices without a triangle are left out of every result. Deterministic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

using MeshEdge = std::pair<std::uint32_t, std::uint32_t>;  // its ends, the smaller number first
std::map<MeshEdge, std::vector<std::size_t>> triangles_of_edges(const TriangleMesh& mesh);

// A vertex within `distance_m` of an earlier one becomes that one. Triangles that have lost a corner or are
// there already are left out.
TriangleMesh welded(const TriangleMesh& mesh, double distance_m);

// Neighbours turn the same way round where two triangles share an edge.
TriangleMesh oriented(TriangleMesh mesh);

// The fewest triangles that meshoptimizer finds within an estimated error of `error_m`: edges are collapsed,
// one vertex into the other. Asks for a welded mesh. Throws std::runtime_error that names the package if this
// build has no meshoptimizer.
TriangleMesh simplified(const TriangleMesh& mesh, double error_m);

}  // namespace tumblesight::sim
