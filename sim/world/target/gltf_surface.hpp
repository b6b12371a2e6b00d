// The surface of a glTF file: its triangles where skins, morph targets and nodes place them.
#pragma once

#include <string>

#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Whether the name ends in .gltf or .glb.
bool is_gltf_name(const std::string& path);

// In the TRF, in metres. Everything is computed in double precision; the vertices are rounded last. Vertices
// are as they come, repeated where the file repeats them.
//
// The file has passed check_gltf() or check_glb(). Throws std::runtime_error that says what is wrong and what
// to do, without the name of the file.
TriangleMesh gltf_surface(const std::string& path, const MeshFileOptions& options);

// What of such a file is not part of its surface, and why: "2 of 10 parts are points or lines ...". Empty if
// there is nothing to say, and for files of other formats. Throws as gltf_surface() does.
std::string gltf_remark(const std::string& path);

}  // namespace tumblesight::sim
