// The triangles of a mesh file as Assimp reads them.
#pragma once

#include <string>

#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// In the TRF, in metres, with node transforms applied. Vertices are as they come: repeated, perhaps not
// finite. Throws std::runtime_error that says what is wrong, without the name of the file.
TriangleMesh import_mesh(const std::string& path, const MeshFileOptions& options);

}  // namespace tumblesight::sim
