// What glTF 2.0 files must hold before Assimp sees them. It trusts their counts: a strip of no points becomes
// four thousand million triangles, a header's length the memory that it reserves.
#pragma once

#include <string>

namespace tumblesight::sim {

// Reads the file's JSON (of a GLB file, its first chunk). Throws std::runtime_error that says what is wrong,
// without the file's name.
void check_gltf(const std::string& path);
void check_glb(const std::string& path);

}  // namespace tumblesight::sim
