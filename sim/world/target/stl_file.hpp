// STL files, binary and ASCII.
#pragma once

#include <string_view>

#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The triangles of all solids of the file, in its order. Normals, attributes and names are not used. Throws
// std::runtime_error that says what is wrong and where, without the name of the file.
TriangleMesh read_stl(std::string_view bytes, const MeshFileOptions& options);

}  // namespace tumblesight::sim
