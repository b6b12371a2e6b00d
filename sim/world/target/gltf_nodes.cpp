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
constexpr double kFlatShare = 1e-7;      // of a determinant, of the cube of the matrix's norm

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

bool is_hidden(const json& node, const std::string& where) {
  const json& visibility = optional(optional(node, "extensions"), "KHR_node_visibility");
  const json& visible = optional(visibility, "visible");
  if (visible.is_null()) return false;
  if (!visible.is_boolean())
    fail(where + "'s KHR_node_visibility is " + shown(visible) + ", neither true nor false");
  return !visible.get<bool>();
}

void check_scenes(const json& scene, const std::vector<std::size_t>& parents) {
  const json& scenes = list(scene, "scenes");
  std::vector<std::size_t> named_by(parents.size(), kNone);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const std::string where = "scene " + std::to_string(i);
    for (const json& number : list(scenes[i], "nodes")) {
      const std::size_t root = whole(number, parents.size(), where + "'s node");
      if (named_by[root] == i) fail(where + " names " + name_of(root) + " twice");
      if (parents[root] != kNone) {
        fail(where + " names " + name_of(root) + ", which is a child of node " +
             std::to_string(parents[root]) + " and no root");
      }
      named_by[root] = i;
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
    (void)is_hidden(nodes[i], name_of(i));
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

SceneNodes nodes_of_scene(const json& scene) {
  struct Open {
    std::size_t node;
    bool below_hidden;
  };
  const json& nodes = list(scene, "nodes");
  SceneNodes found;
  std::vector<Open> open;
  const auto push = [&open](const json& numbers, bool below_hidden) {
    for (auto number = numbers.rbegin(); number != numbers.rend(); ++number)
      open.push_back({number->get<std::size_t>(), below_hidden});
  };
  push(list(list(scene, "scenes")[chosen_scene(scene)], "nodes"), false);
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const bool hidden = next.below_hidden || is_hidden(nodes[next.node], name_of(next.node));
    (hidden ? found.hidden : found.visible).push_back(next.node);
    push(list(nodes[next.node], "children"), hidden);
  }
  return found;
}

bool is_singular(const Eigen::Matrix4d& placement) {
  const Eigen::Matrix3d axes = placement.topLeftCorner<3, 3>();
  return std::abs(axes.determinant()) <= kFlatShare * std::pow(axes.norm(), 3);
}

Placements::Placements(const json& scene) : parents_(parents_of(scene)) {
  const json& nodes = list(scene, "nodes");
  for (std::size_t i = 0; i < nodes.size(); ++i) locals_.push_back(local_placement(nodes[i], name_of(i)));
  placements_ = locals_;
  std::vector<bool> is_placed(nodes.size(), false);
  std::vector<std::size_t> open;  // ancestors that are not placed yet, the highest last
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t at = i; at != kNone && !is_placed[at]; at = parents_[at]) open.push_back(at);
    for (; !open.empty(); open.pop_back()) {
      const std::size_t at = open.back();
      if (parents_[at] != kNone) placements_[at] = placements_[parents_[at]] * locals_[at];
      is_placed[at] = true;
    }
  }
}

std::size_t Placements::flattening(std::size_t node) const {
  for (std::size_t at = node; at != kNone; at = parents_[at]) {
    if (is_singular(locals_[at])) return at;
  }
  return node;
}

}  // namespace tumblesight::sim::gltf
