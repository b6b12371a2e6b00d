// Effects on the body that is observed. The network still expects the unchanged one.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/target/panels.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

// Across the bounding box of a part that can be missing, over the target's radius.
constexpr double kSmallestMissingPart = 1.0 / 6.0;
constexpr double kLargestMissingPart = 1.0 / 4.0;
constexpr int kSphereSides = 96;

Eigen::AlignedBox3f box_around(const TriangleMesh& mesh, const std::vector<std::size_t>& triangles) {
  Eigen::AlignedBox3f box;
  for (const std::size_t triangle : triangles) {
    for (const std::uint32_t corner : mesh.triangles[triangle]) box.extend(mesh.vertices_trf_m[corner]);
  }
  return box;
}

void leave_out(const std::vector<std::size_t>& triangles, TriangleMesh& mesh) {
  std::vector<std::uint8_t> out(mesh.triangles.size());
  for (const std::size_t triangle : triangles) out[triangle] = 1;
  TriangleMesh kept = mesh;
  kept.triangles.clear();
  kept.is_panel.clear();
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] != 0) continue;
    kept.triangles.push_back(mesh.triangles[i]);
    if (!mesh.is_panel.empty()) kept.is_panel.push_back(mesh.is_panel[i]);
  }
  mesh = std::move(kept);
}

// Every panel is turned about its own hinge by a new angle_deg(), right-handed about the direction outwards.
TriangleMesh with_panels_at(const char* effect, const TriangleMesh& mesh,
                            const std::function<double()>& angle_deg) {
  TriangleMesh changed = mesh;
  for (const Panel& panel : panels_for_effect(effect, mesh)) {
    const Eigen::Isometry3d turn = Eigen::Translation3d(panel.centre_trf_m) *
                                   Eigen::AngleAxisd(kRadPerDeg * angle_deg(), panel.hinge_trf) *
                                   Eigen::Translation3d(-panel.centre_trf_m);
    // A corner that the panel shares with another part stays with that part.
    for (const std::size_t triangle : panel.triangles) {
      for (std::uint32_t& corner : changed.triangles[triangle]) {
        const Eigen::Vector3d from = mesh.vertices_trf_m[corner].cast<double>();
        corner = static_cast<std::uint32_t>(changed.vertices_trf_m.size());
        changed.vertices_trf_m.push_back((turn * from).cast<float>());
      }
    }
  }
  return changed;
}

}  // namespace

// Every solar panel stands at an angle of its own, drawn within `strength` of the limits of the target's
// joints. Limit: only panels move, not their booms, and no antenna.
std::vector<TriangleMesh> with_moved_joints(const std::function<double()>& strength, Random& random,
                                            const std::string& target, const TriangleMesh& mesh) {
  const JointLimits limits = joint_limits(target);
  if (limits.lowest_deg == limits.highest_deg) {
    throw std::invalid_argument("effect joints: the panels of " + display_name(target) +
                                " are fixed; panel_turn turns them from the model");
  }
  const double share = strength();
  return {with_panels_at("joints", mesh,
                         [&] { return share * random.uniform(limits.lowest_deg, limits.highest_deg); })};
}

// Of the connected parts that are a sixth to a quarter of the target's radius across, the `strength` ones
// whose boxes lie farthest from the TRF's origin are missing: instruments that stick out. On NASA's mesh of
// NEAR Shoemaker the first one is the telescope on a corner of the aft deck.
std::vector<TriangleMesh> without_parts(const std::function<double()>& strength, Random&, const std::string&,
                                        const TriangleMesh& mesh) {
  struct Part {
    float distance_m;
    std::vector<std::size_t> triangles;
  };
  std::vector<Part> parts;
  for (const std::vector<std::size_t>& triangles : connected_parts(mesh)) {
    const Eigen::AlignedBox3f box = box_around(mesh, triangles);
    const double size = box.diagonal().norm() / mesh.radius_m();
    if (size < kSmallestMissingPart || size > kLargestMissingPart) continue;
    parts.push_back({box.center().norm(), triangles});
  }
  const auto count = static_cast<std::size_t>(std::lround(strength()));
  if (parts.size() < count) {
    throw std::invalid_argument("effect part_missing: " + mesh.name + " has only " +
                                std::to_string(parts.size()) +
                                " separate parts of a sixth to a quarter of its radius");
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.distance_m > b.distance_m; });
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < count; ++i)
    missing.insert(missing.end(), parts[i].triangles.begin(), parts[i].triangles.end());
  TriangleMesh changed = mesh;
  leave_out(missing, changed);
  return {changed};
}

// Every panel is turned about its own hinge by `strength` degrees, right-handed about the direction outwards;
// each by a strength of its own if that is drawn.
std::vector<TriangleMesh> with_turned_panels(const std::function<double()>& strength, Random&,
                                             const std::string&, const TriangleMesh& mesh) {
  return {with_panels_at("panel_turn", mesh, strength)};
}

// Each sequence shows one of the other shipped spacecraft, in its true size. Another configuration of the
// same spacecraft is not another one.
std::vector<TriangleMesh> other_targets(const std::function<double()>&, Random&, const std::string& target,
                                        const TriangleMesh&) {
  const auto spacecraft = [](const std::string& key) {
    const Mission* mission = find_target(key);
    return mission != nullptr && !mission->paper_target.empty() ? mission->paper_target : key;
  };
  std::vector<TriangleMesh> others;
  for (const std::string& key : target_names()) {
    if (spacecraft(key) != spacecraft(target)) others.push_back(target_by_name(key));
  }
  return others;
}

// A sphere of `strength` times the target's radius, around the TRF's origin.
std::vector<TriangleMesh> a_sphere(const std::function<double()>& strength, Random&, const std::string&,
                                   const TriangleMesh& mesh) {
  const auto radius = static_cast<float>(strength() * mesh.radius_m());
  Outline profile;
  for (int i = 0; i <= kSphereSides / 2; ++i) {
    const float angle = 2.0F * kPi_f * static_cast<float>(i) / static_cast<float>(kSphereSides);
    const bool pole = i == 0 || 2 * i == kSphereSides;
    profile.emplace_back(pole ? 0.0F : radius * std::sin(angle), radius * std::cos(angle));
  }
  TriangleMesh sphere = revolve(profile, kSphereSides);
  sphere.name = "sphere";
  return {sphere};
}

}  // namespace tumblesight::sim
