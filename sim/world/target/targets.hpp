// The targets that ship with Tumblesight, by name.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

std::vector<std::string> target_names();
// The mesh of a shipped target, its name set. Throws std::invalid_argument that names the targets there are.
TriangleMesh target_by_name(const std::string& name);
// Inertia tensor of a shipped target about its centre of mass, in the TRF's directions (paper, spacecraft
// table). The paper's Aquarius is in y-up axes, as the display model is: only read so are its plane of
// symmetry and its axis of least inertia (28 deg from z) those of the mesh. It is turned into the z-up TRF
// here. It is that of the flight configuration and serves for the stowed one too. Throws as target_by_name
// does.
Eigen::Matrix3d inertia_kg_m2(const std::string& target);

}  // namespace tumblesight::sim
