// Checks of glTF 2.0 files before Assimp reads them. Assimp trusts their counts: it turns a strip without
// points into four billion triangles and reserves as much memory as a header claims.
#pragma once

#include <string>

namespace tumblesight::sim {

// Check the JSON of the file (in a GLB file: its first chunk). Throw std::runtime_error that says what is
// wrong, without the name of the file.
void check_gltf(const std::string& path);
void check_glb(const std::string& path);

}  // namespace tumblesight::sim
