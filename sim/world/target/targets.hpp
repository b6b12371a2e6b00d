// The table of the targets that ship with Tumblesight. Command line, evaluation, training and reports all
// follow it.
//
// To add a target: its mesh in a file of its own (as near_shoemaker.cpp), its row in targets.cpp, its model
// images in fsw/models. Figures of the paper are optional (sim/evaluation/paper.cpp).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/world/target/mesh_file.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Elements of an inertia tensor, products of inertia with their minus sign.
struct InertiaElements {
  double xx, yy, zz, xy, xz, yz;  // kg m^2
};

// How far a solar panel turns from where it stands in the mesh, about its hinge (panels.hpp), right-handed
// about the direction outwards. Both 0: it is fixed.
struct JointLimits {
  double lowest_deg, highest_deg;
};

struct TargetRow {
  const char* key;           // on the command line, in model images, in file names: 1 to 31 of a-z, 0-9 and _
  const char* display_name;  // in reports
  TriangleMesh (*make_mesh)();
  // About the centre of mass, in the TRF's directions.
  InertiaElements inertia;
  // The target looks nearly the same after 1/n of a turn about z; 1: no such symmetry.
  int symmetry_about_z;
  // Key of the target in the paper whose figures this target is compared with; nullptr: none.
  const char* paper_key;
  JointLimits joints;  // of every panel
};

// nullptr for a target that does not ship, for instance a user's own.
const TargetRow* find_target(const std::string& key);

std::vector<std::string> target_names();  // the keys
// "NEAR Shoemaker" for "near_shoemaker"; a target that does not ship keeps its key.
std::string display_name(const std::string& target);
// The mesh of a shipped target, its name set. Throws std::invalid_argument that lists the shipped targets if
// `name` is not one of them.
TriangleMesh target_by_name(const std::string& name);
// Inertia tensor of a shipped target (paper, spacecraft table), see TargetRow::inertia. Throws as
// target_by_name does.
Eigen::Matrix3d inertia_kg_m2(const std::string& target);

// Of the panels of a target; a whole turn for one that does not ship.
JointLimits joint_limits(const std::string& target);

// Stands for the mesh that ships for a target, wherever a mesh file may be named.
inline constexpr const char* kParametricMesh = "parametric";

// The surface of a target as the user names it. `source`: kParametricMesh, or a file that is read with
// `options`. Throws as target_by_name and load_mesh_file do.
TriangleMesh target_mesh(const std::string& target, const std::string& source,
                         const MeshFileOptions& options = {});

}  // namespace tumblesight::sim
