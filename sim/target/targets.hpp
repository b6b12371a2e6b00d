// The targets that ship with Tumblesight, by name.
#pragma once

#include <string>
#include <vector>

#include "sim/target/triangle_mesh.hpp"

namespace tumblesight::sim {

std::vector<std::string> target_names();
// The mesh of a shipped target, its name set. Throws std::invalid_argument that names the targets there are.
TriangleMesh target_by_name(const std::string& name);

}  // namespace tumblesight::sim
