// glTF files whose meshes are compressed with Draco (extension KHR_draco_mesh_compression), as most public
// models of spacecraft are. Assimp reads them in some builds only, and none with more than 65,536 vertices in
// a part.
#pragma once

#include <string>

namespace tumblesight::sim {

// The surface of a compressed .gltf or .glb file as a GLB file without compression: positions, triangles,
// nodes, names of materials. Empty if the file is of another format or holds no compressed mesh.
//
// The file has passed check_gltf() or check_glb(). Throws std::runtime_error that says what is wrong and what
// to do, without the name of the file.
std::string without_draco(const std::string& path);

}  // namespace tumblesight::sim
