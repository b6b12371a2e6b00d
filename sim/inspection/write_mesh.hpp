// Mesh files that are written: STL and OBJ, in metres, in the axes of the TRF (z up).
#pragma once

#include <string>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Binary STL, or OBJ if the path ends in .obj. An OBJ file names the material of the parts that are marked as
// panels, in a file of materials beside it (materials_of). Throws std::invalid_argument for another ending,
// std::runtime_error if a file cannot be written.
void write_mesh(const std::string& path, const TriangleMesh& mesh);

// The file of materials beside an OBJ file: its name with the ending .mtl.
std::string materials_of(const std::string& path);

}  // namespace tumblesight::sim
