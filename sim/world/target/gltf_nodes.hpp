// The nodes of a glTF file: which stand in its scene, and where they put their parts.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "sim/world/target/gltf_file.hpp"

namespace tumblesight::sim::gltf {

// Deeper hierarchies exhaust the stack of readers that recurse. Rigs of robots have a few dozen levels.
inline constexpr std::size_t kMaxNodeDepth = 256;

// Throws std::runtime_error, without the name of the file, for nodes that are their own ancestors, that have
// two parents or too many ancestors, for numbers of nodes, meshes or skins that do not exist, and for
// transforms that are no placement.
void check_nodes(const json& scene);

// The rest is for files that passed check_nodes().

// The number of the scene that is read; throws if there is none.
std::size_t chosen_scene(const json& scene);
// Its nodes, parents first. Hidden are those that KHR_node_visibility makes invisible, and all below them.
struct SceneNodes {
  std::vector<std::size_t> visible, hidden;
};
SceneNodes nodes_of_scene(const json& scene);
// From the axes of each node to those of the scene. Double precision throughout: large translations of a
// chain of nodes cancel, and what remains must be exact to far less than a millimetre.
class Placements {
 public:
  explicit Placements(const json& scene);
  const Eigen::Matrix4d& of(std::size_t node) const { return placements_[node]; }
  // The node or the nearest of its ancestors whose own transform is singular; the node itself if none is.
  std::size_t flattening(std::size_t node) const;

 private:
  std::vector<std::size_t> parents_;
  std::vector<Eigen::Matrix4d> locals_, placements_;
};
// Whether a placement makes bodies flat: it scales a direction by zero.
bool is_singular(const Eigen::Matrix4d& placement);

}  // namespace tumblesight::sim::gltf
