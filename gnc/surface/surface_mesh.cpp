#include "gnc/surface/surface_mesh.hpp"

namespace tumblesight::gnc {

bool SurfaceMesh::is_sound(const std::uint8_t* section, std::size_t size_bytes) {
  if (size_bytes < kHeaderBytes) return false;
  const std::int32_t vertices = u16(section), triangles = u16(section + 2), edges = u16(section + 4);
  if (vertices > kMaxVertices || triangles > kMaxTriangles || edges > kMaxEdges) return false;
  const std::size_t vertex_end = kHeaderBytes + std::size_t{6} * vertices;
  const std::size_t end = vertex_end + std::size_t{6} * triangles + std::size_t{8} * edges;
  if (size_bytes < end) return false;
  for (std::size_t at = vertex_end; at < end; at += 2) {
    if (u16(section + at) >= vertices) return false;
  }
  return true;
}

}  // namespace tumblesight::gnc
