#include "sim/cli/surfaces.hpp"

#include "sim/cli/arguments.hpp"
#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {

void add_surface_options(CLI::App& command, SurfaceArguments& arguments) {
  command
      .add_option("--mesh", arguments.meshes,
                  "surface of the target: a CAD file, or 'parametric' for the shipped mesh; may be repeated")
      ->capture_default_str();
  command.add_option("--mesh-up", arguments.mesh_up, "axis that points up in the files")
      ->check(one_of({"y", "z"}))
      ->capture_default_str();
  command.add_option("--mesh-scale", arguments.mesh_scale, "metres per unit of the files")
      ->check(number(1e-6, 1e6))
      ->capture_default_str();
}

std::vector<TriangleMesh> load_surfaces(const SurfaceArguments& arguments, const std::string& target) {
  std::vector<TriangleMesh> meshes;
  for (const std::string& name : arguments.meshes) {
    if (name == "parametric") {
      meshes.push_back(target_by_name(target));
      continue;
    }
    MeshFileOptions file;
    file.up = mesh_up_from(arguments.mesh_up);
    file.scale = arguments.mesh_scale;
    meshes.push_back(load_mesh_file(name, file));
  }
  return meshes;
}

}  // namespace tumblesight::sim
