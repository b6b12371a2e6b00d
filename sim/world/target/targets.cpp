#include "sim/world/target/targets.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

// The paper gives Aquarius in y-up axes, as the display model is: only then do its plane of symmetry and its
// axis of least inertia (28 deg from z) agree with the mesh. Its (X, Y, Z) are the TRF's (x, z, -y). The
// tensor is that of the flight configuration and is used for the stowed one too.
constexpr InertiaElements kAquariusInertia = {2644.24, 3086.41, 1329.64, 2.10, 972.97, -11.49};

// NEAR Shoemaker's panels are fixed. Magellan's follow the Sun about x; the stops of their drives are not
// known here. Those of Aquarius do not track the Sun (shipped_meshes.hpp), and locks hold the stowed ones.
constexpr JointLimits kFixed = {0.0, 0.0};
constexpr JointLimits kWholeTurn = {-180.0, 180.0};

constexpr TargetRow kTargets[] = {
    {"near_shoemaker",
     "NEAR Shoemaker",
     make_near_shoemaker,
     {372.38, 372.45, 316.17, -2.86, -2.95, -4.42},
     4,
     "near_shoemaker",
     kFixed},
    {"magellan",
     "Magellan",
     make_magellan,
     {3266.61, 4772.03, 2897.59, 2.62, 36.17, -42.65},
     2,
     "magellan",
     kWholeTurn},
    {"sacd_aquarius", "SAC-D/Aquarius", make_sacd_aquarius, kAquariusInertia, 1, "sacd_aquarius", kFixed},
    {"sacd_aquarius_stowed", "SAC-D/Aquarius, stowed", make_sacd_aquarius_stowed, kAquariusInertia, 1,
     "sacd_aquarius", kFixed},
};

std::string known_targets() {
  std::string known;
  for (const TargetRow& row : kTargets) known += (known.empty() ? "" : ", ") + std::string(row.key);
  return known;
}

const TargetRow& shipped_target(const std::string& key) {
  if (const TargetRow* row = find_target(key)) return *row;
  throw std::invalid_argument("target '" + key + "' is unknown; the targets are: " + known_targets());
}

}  // namespace

const TargetRow* find_target(const std::string& key) {
  const TargetRow* row = std::find_if(std::begin(kTargets), std::end(kTargets),
                                      [&](const TargetRow& r) { return key == r.key; });
  return row == std::end(kTargets) ? nullptr : row;
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const TargetRow& row : kTargets) names.emplace_back(row.key);
  return names;
}

std::string display_name(const std::string& target) {
  const TargetRow* row = find_target(target);
  return row != nullptr ? row->display_name : target;
}

TriangleMesh target_by_name(const std::string& name) {
  return shipped_target(name).make_mesh();
}

Eigen::Matrix3d inertia_kg_m2(const std::string& target) {
  const InertiaElements& i = shipped_target(target).inertia;
  Eigen::Matrix3d tensor;
  tensor << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  return tensor;
}

JointLimits joint_limits(const std::string& target) {
  const TargetRow* row = find_target(target);
  return row != nullptr ? row->joints : kWholeTurn;
}

TriangleMesh target_mesh(const std::string& target, const std::string& source,
                         const MeshFileOptions& options) {
  if (source != kParametricMesh) return load_mesh_file(source, options);
  if (find_target(target) == nullptr)
    throw std::invalid_argument("target '" + target +
                                "' does not ship, so there is no mesh of it here; give its file with --mesh, "
                                "or one of the targets that ship: " +
                                known_targets());
  return target_by_name(target);
}

}  // namespace tumblesight::sim
