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
// Its nodes, parents first.
std::vector<std::size_t> nodes_of_scene(const json& scene);
// From the axes of each node to those of the scene.
class Placements {
 public:
  explicit Placements(const json& scene);
  Eigen::Matrix4d of(std::size_t node) const;

 private:
  const json& nodes_;
  std::vector<std::size_t> parents_;
};

}  // namespace tumblesight::sim::gltf
