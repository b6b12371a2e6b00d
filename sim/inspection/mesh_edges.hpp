// Edges of a mesh and repeated triangles: whether the surface is closed, and whether its triangles are turned
// the same way. The sensor model sees both sides of every triangle, so none of this is a fault for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct MeshEdges {
  std::size_t edges = 0;
  std::size_t open = 0;     // of one triangle
  std::size_t crowded = 0;  // of more than two triangles
  std::size_t turned = 0;   // of two triangles that turn opposite ways round
};

// Of a mesh whose equal vertices are joined.
MeshEdges edges_of(const TriangleMesh& mesh);

// Per triangle: 1 if an earlier one has the same corners, whichever way round.
std::vector<std::uint8_t> repeated_triangles(const TriangleMesh& mesh);

}  // namespace tumblesight::sim
