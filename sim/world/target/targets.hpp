// The targets: those that ship, each a mission file in sim/world/target/missions, and that of the user's own
// mission. Command line, evaluation, training and reports all follow them.
//
// To add a target that ships: its mission file, its model images in fsw/models. A parametric mesh has its row
// in shipped_meshes.cpp. Figures of the paper are optional (sim/evaluation/paper.cpp).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/mission/mission.hpp"
#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// The missions of the targets that ship.
const std::vector<Mission>& shipped_missions();
std::vector<std::string> target_names();  // their names
const std::string& default_target();      // the first one's

// A mission that ships, by its name, or a file. Throws std::invalid_argument as read_mission() does, or that
// lists the names if there is no such file.
Mission mission_named(const std::string& name_or_file, const std::vector<std::string>& conditions);
// The file of a mission that ships, by its name; any other text is a file itself.
std::string mission_path(const std::string& name_or_file);

// From now on the target of the mission is known by its name, in place of one that ships under it. For the
// start of a program: not safe beside other threads.
void use_mission(const Mission& mission);

// nullptr for a target that neither ships nor is that of use_mission().
const Mission* find_target(const std::string& name);

// "NEAR Shoemaker" for "near_shoemaker"; a target that is not known keeps its name.
std::string display_name(const std::string& target);
// The mesh that ships, its name set. Throws std::invalid_argument that lists the shipped targets if `name` is
// not one of them.
TriangleMesh target_by_name(const std::string& name);
// In the TRF; empty for a target that is not known or whose mission has none.
std::optional<Eigen::Matrix3d> known_inertia_kg_m2(const std::string& target);
// The same. Throws std::invalid_argument if it is empty.
Eigen::Matrix3d inertia_kg_m2(const std::string& target);

// Of the panels of a target; a whole turn for one that is not known or whose mission does not say.
JointLimits joint_limits(const std::string& target);

// The surface of a target as the user names it. `source`: kParametricMesh, or a file that is read with
// `options`. Throws as target_by_name and load_mesh_file do.
TriangleMesh target_mesh(const std::string& target, const std::string& source,
                         const MeshFileOptions& options = {});
MeshFileOptions mesh_file_options(const MissionMesh& mesh);

// Identifies what a network is trained for: name, mesh (the bytes of its files), its axes, unit and origin,
// inertia, panels. Not how it is seen, goals or time. Throws std::runtime_error if the mesh cannot be read.
std::uint32_t mission_crc32(const Mission& mission);

}  // namespace tumblesight::sim
