// The surface of a target as the user names it: the mesh that ships, or a file.
#pragma once

#include <string>

#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {

// Stands for the mesh that ships for a target, wherever a mesh file may be named.
inline constexpr const char* kParametricMesh = "parametric";

// `source`: kParametricMesh, or a file that is read with `options`. Throws as target_by_name and
// load_mesh_file do.
TriangleMesh target_mesh(const std::string& target, const std::string& source,
                         const MeshFileOptions& options = {});

}  // namespace tumblesight::sim
