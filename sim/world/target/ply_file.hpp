// PLY files, as scanners write them: ASCII and binary of both byte orders.
#pragma once

#include <string_view>

#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The faces of the file, polygons divided into triangles. Colours, normals and elements other than vertices
// and faces are not used. Throws std::runtime_error that says what is wrong and where, without the name of
// the file; a cloud of points without faces is refused.
TriangleMesh read_ply(std::string_view bytes, const MeshFileOptions& options);

}  // namespace tumblesight::sim
