// What is wrong with a mesh of the user's own, in one line per finding, before a network learns it.
#pragma once

#include <string>
#include <vector>

#include "sim/cli/arguments.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Prints the faults and warnings of each mesh that comes from a file to the standard error stream, with the
// command that shows more. Takes a few seconds per file. `meshes`: those of the arguments.
void print_mesh_warnings(const MeshArguments& arguments, const std::vector<TriangleMesh>& meshes);

}  // namespace tumblesight::sim
