// The surface of a glTF file, as a GLB file that holds nothing else. Assimp reads that one instead: it does
// not apply skins or morph targets, does not decode Draco in every build, takes wrong counts and addresses on
// trust, and opens whatever the file names.
#pragma once

#include <string>

namespace tumblesight::sim {

// Whether the name ends in .gltf or .glb.
bool is_gltf_name(const std::string& path);

// Positions, corners, nodes and names of materials of a .gltf or .glb file. Parts that a skin or morph
// targets change are written as these place them; of all others every number is that of the file.
//
// The file has passed check_gltf() or check_glb(). Throws std::runtime_error that says what is wrong and what
// to do, without the name of the file.
std::string gltf_surface(const std::string& path);

// What of such a file is not part of its surface, and why: "2 of 10 parts are points or lines ...". Empty if
// there is nothing to say, and for files of other formats. Throws as gltf_surface() does.
std::string gltf_remark(const std::string& path);

}  // namespace tumblesight::sim
