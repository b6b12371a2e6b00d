#include "sim/world/target/triangle_mesh.hpp"

#include <algorithm>

namespace tumblesight::sim {

float TriangleMesh::radius_m() const {
  float radius = 0.0F;
  for (const Eigen::Vector3f& vertex : vertices_trf_m) {
    radius = std::max(radius, vertex.norm());
  }
  return radius;
}

}  // namespace tumblesight::sim
