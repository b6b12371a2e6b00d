#include "sim/world/target/gltf_nodes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace tumblesight::sim::gltf {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr double kUnitTolerance = 0.01;  // of the length of a rotation's quaternion
constexpr double kRowTolerance = 1e-6;   // of the last row of a matrix

std::string name_of(std::size_t node) {
  return "node " + std::to_string(node);
}

std::vector<std::size_t> parents_of(const json& scene) {
  const json& nodes = list(scene, "nodes");
  std::vector<std::size_t> parents(nodes.size(), kNone);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].is_object()) fail(name_of(i) + " is not an object");
    for (const json& number : list(nodes[i], "children")) {
      const std::size_t child = whole(number, nodes.size(), name_of(i) + "'s child");
      if (parents[child] != kNone) {
        fail(name_of(child) + " has two parents, nodes " + std::to_string(parents[child]) + " and " +
             std::to_string(i));
      }
      parents[child] = i;
    }
  }
  return parents;
}

void check_depths(const std::vector<std::size_t>& parents) {
  for (std::size_t i = 0; i < parents.size(); ++i) {
    std::size_t depth = 0;
    for (std::size_t at = parents[i]; at != kNone && depth <= parents.size(); at = parents[at]) ++depth;
    if (depth > parents.size()) fail(name_of(i) + " is below itself: its ancestors form a ring");
    if (depth >= kMaxNodeDepth) {
      fail(name_of(i) + " has " + std::to_string(depth) + " ancestors; at most " +
           std::to_string(kMaxNodeDepth - 1) + " are read");
    }
  }
}

// The numbers of a member such as "translation"; what stands for it if there is none.
std::vector<double> numbers(const json& node, const char* key, std::vector<double> absent,
                            const std::string& where) {
  const json& values = optional(node, key);
  if (values.is_null()) return absent;
  const std::string what = where + "'s " + key;
  if (!values.is_array() || values.size() != absent.size()) {
    fail(what + " is " + shown(values) + ", not " + std::to_string(absent.size()) + " numbers");
  }
  for (std::size_t i = 0; i < absent.size(); ++i) {
    if (!values[i].is_number() || std::abs(values[i].get<double>()) > std::numeric_limits<float>::max()) {
      fail(what + " holds " + shown(values[i]) + ", which is not a finite number");
    }
    absent[i] = values[i].get<double>();
  }
  return absent;
}

Eigen::Matrix4d local_placement(const json& node, const std::string& where) {
  const std::vector<double> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const bool has_matrix = !optional(node, "matrix").is_null();
  const std::vector<double> m = numbers(node, "matrix", identity, where);
  const std::vector<double> t = numbers(node, "translation", {0, 0, 0}, where);
  const std::vector<double> r = numbers(node, "rotation", {0, 0, 0, 1}, where);
  const std::vector<double> s = numbers(node, "scale", {1, 1, 1}, where);
  if (has_matrix) {
    const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(m.data());
    if ((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() > kRowTolerance)
      fail(where + "'s matrix is not a placement: its last row is not 0, 0, 0, 1");
    return matrix;
  }
  const Eigen::Quaterniond rotation(r[3], r[0], r[1], r[2]);
  if (std::abs(rotation.norm() - 1.0) > kUnitTolerance) {
    fail(where + "'s rotation is " + shown(node["rotation"]) + ": a quaternion of length 1 is needed");
  }
  const Eigen::Affine3d placement = Eigen::Translation3d(t[0], t[1], t[2]) * rotation.normalized();
  return (placement * Eigen::Scaling(s[0], s[1], s[2])).matrix();
}

void check_scenes(const json& scene, const std::vector<std::size_t>& parents) {
  const json& scenes = list(scene, "scenes");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const std::string where = "scene " + std::to_string(i);
    std::vector<bool> named(parents.size(), false);
    for (const json& number : list(scenes[i], "nodes")) {
      const std::size_t root = whole(number, parents.size(), where + "'s node");
      if (named[root]) fail(where + " names " + name_of(root) + " twice");
      if (parents[root] != kNone) {
        fail(where + " names " + name_of(root) + ", which is a child of node " +
             std::to_string(parents[root]) + " and no root");
      }
      named[root] = true;
    }
  }
}

}  // namespace

void check_nodes(const json& scene) {
  const std::vector<std::size_t> parents = parents_of(scene);
  check_depths(parents);
  check_scenes(scene, parents);
  const json& nodes = list(scene, "nodes");
  const std::size_t meshes = list(scene, "meshes").size(), skins = list(scene, "skins").size();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    (void)local_placement(nodes[i], name_of(i));
    (void)whole_or(nodes[i], "mesh", 0, meshes, name_of(i));
    (void)whole_or(nodes[i], "skin", 0, skins, name_of(i));
  }
}

std::size_t chosen_scene(const json& scene) {
  const json& scenes = list(scene, "scenes");
  const std::size_t meshes = list(scene, "meshes").size();
  if (scenes.empty()) {
    refuse("has no scene that says where its meshes (" + std::to_string(meshes) +
           ") stand; put the parts into a scene and export it again");
  }
  return whole_or(scene, "scene", 0, scenes.size(), "the file");
}

std::vector<std::size_t> nodes_of_scene(const json& scene) {
  const json& nodes = list(scene, "nodes");
  std::vector<std::size_t> found, open;
  const auto push = [&open](const json& numbers) {
    for (auto number = numbers.rbegin(); number != numbers.rend(); ++number)
      open.push_back(number->get<std::size_t>());
  };
  push(list(list(scene, "scenes")[chosen_scene(scene)], "nodes"));
  while (!open.empty()) {
    found.push_back(open.back());
    open.pop_back();
    push(list(nodes[found.back()], "children"));
  }
  return found;
}

Placements::Placements(const json& scene) : nodes_(list(scene, "nodes")), parents_(parents_of(scene)) {}

Eigen::Matrix4d Placements::of(std::size_t node) const {
  Eigen::Matrix4d placement = Eigen::Matrix4d::Identity();
  for (std::size_t at = node; at != kNone; at = parents_[at])
    placement = local_placement(nodes_[at], name_of(at)) * placement;
  return placement;
}

}  // namespace tumblesight::sim::gltf
