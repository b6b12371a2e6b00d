#include "sim/world/target/target_mesh.hpp"

#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {

TriangleMesh target_mesh(const std::string& target, const std::string& source,
                         const MeshFileOptions& options) {
  return source == kParametricMesh ? target_by_name(target) : load_mesh_file(source, options);
}

}  // namespace tumblesight::sim
