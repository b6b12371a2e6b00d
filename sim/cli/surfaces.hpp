// The surfaces that a network is trained for or quantized with: shipped meshes and CAD files, in one option.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

struct SurfaceArguments {
  std::vector<std::string> meshes{"parametric"};
  std::string mesh_up = "y";
  double mesh_scale = 1.0;
};

void add_surface_options(CLI::App& command, SurfaceArguments& arguments);  // --mesh, --mesh-up, --mesh-scale
// 'parametric' is the shipped mesh of `target`. Throws as target_by_name and load_mesh_file do.
std::vector<TriangleMesh> load_surfaces(const SurfaceArguments& arguments, const std::string& target);

}  // namespace tumblesight::sim
