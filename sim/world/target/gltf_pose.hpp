// The vertices of a part as its morph targets and its skin place them.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "sim/world/target/gltf_data.hpp"
#include "sim/world/target/gltf_nodes.hpp"

namespace tumblesight::sim::gltf {

// A primitive of a mesh at a node. `where` names it in messages.
struct Part {
  const json& mesh;
  const json& primitive;
  std::string where;
};

// The weights of a node's morph targets: its own, or those of its mesh. All zero: none.
std::vector<double> morph_weights(const json& node, const json& mesh, const std::string& where);

// Adds the targets to the positions, three numbers per vertex.
void morph(const Part& part, const std::vector<double>& weights, const Data& data,
           std::vector<double>& positions);

// By joint of a skin, from the axes of a part to those of the scene.
using Joints = std::vector<Eigen::Matrix4d>;
Joints joints_of(const json& scene, std::size_t skin, const Data& data, const Placements& placements);

// Puts the positions where the joints have them, in the axes of the scene. The placement of the node itself
// does not count for a part with a skin, by the standard.
void apply_skin(const json& scene, const Joints& joints, const Part& part, const Data& data,
                std::vector<double>& positions);

}  // namespace tumblesight::sim::gltf
