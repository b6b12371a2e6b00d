// OBJ files: their polygons. Free-form surfaces are refused.
#pragma once

#include <string>
#include <string_view>

#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The triangles of the file, material by material: in the order of the materials in its libraries, then of
// their first use. Only the positions of the corners and the names of the materials are used. `path`: beside
// which the libraries are looked for; one that is missing is no fault. Throws std::runtime_error that says
// what is wrong and where, without the name of the file.
TriangleMesh read_obj(std::string_view text, const std::string& path, const MeshFileOptions& options);

}  // namespace tumblesight::sim
