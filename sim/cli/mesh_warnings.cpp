#include "sim/cli/mesh_warnings.hpp"

#include <fmt/format.h>

#include "sim/host/text.hpp"
#include "sim/inspection/mesh_inspection.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {

void print_mesh_warnings(const MeshArguments& arguments, const std::vector<TriangleMesh>& meshes) {
  const MeshFileOptions options{mesh_up_from(arguments.mesh_up), arguments.mesh_scale};
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (arguments.meshes[i] == kParametricMesh) continue;
    bool any = false;
    for (const Finding& finding : inspect(meshes[i], options).findings) {
      if (finding.severity == Severity::kNote) continue;
      print_message(fmt::format("warning: mesh '{}': {}", arguments.meshes[i], finding.text));
      any = true;
    }
    if (any)
      print_message(fmt::format(
          "warning: `tumblesight mesh {} --mesh-up {} --mesh-scale {:g}` shows more, and what to do",
          arguments.meshes[i], arguments.mesh_up, arguments.mesh_scale));
  }
}

}  // namespace tumblesight::sim
