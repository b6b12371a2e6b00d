#include "sim/world/target/gltf_pose.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/world/target/gltf_draco.hpp"

namespace tumblesight::sim::gltf {
namespace {

constexpr std::size_t kPerVertex = 4;  // joints of one set

// Joints or weights of one set, four per vertex; empty if there is none.
std::vector<float> of_set(const json& scene, const Part& part, const std::string& name, const Data& data) {
  const json& extension = draco_of(part.primitive);
  if (extension.is_object()) {
    std::vector<float> values = draco_attribute(extension, data, name.c_str());
    if (!values.empty()) return values;
  }
  const json& number = optional(optional(part.primitive, "attributes"), name.c_str());
  if (number.is_null()) return {};
  const std::string what = part.where + "'s " + name;
  if (optional(list(scene, "accessors")[number.get<std::size_t>()], "type") != "VEC4")
    fail(what + " is not VEC4");
  return data.floats(number.get<std::size_t>(), what);
}

void add_weighted(const Joints& joints, float joint, double weight, const Part& part, std::size_t vertex,
                  Eigen::Matrix4d& sum) {
  if (weight == 0.0) return;
  if (!(joint >= 0.0F && joint < static_cast<float>(joints.size()))) {
    fail(part.where + "'s vertex " + std::to_string(vertex) + " names joint " +
         std::to_string(static_cast<long long>(joint)) + ", and its skin has " +
         std::to_string(joints.size()));
  }
  sum += weight * joints[static_cast<std::size_t>(joint)];
}

}  // namespace

Joints joints_of(const json& scene, std::size_t number, const Data& data, const Placements& placements) {
  const std::string where = "skin " + std::to_string(number);
  const json& skin = list(scene, "skins")[number];
  const json& joints = list(skin, "joints");
  if (joints.empty()) fail(where + " has no joints");
  const json& bind = optional(skin, "inverseBindMatrices");
  std::vector<float> inverse;
  if (!bind.is_null()) {
    const std::string what = where + "'s inverseBindMatrices";
    const json& accessors = list(scene, "accessors");
    const std::uint64_t accessor = whole(bind, accessors.size(), what);
    if (optional(accessors[accessor], "type") != "MAT4" ||
        optional(accessors[accessor], "componentType") != kFloat)
      fail(what + " are not MAT4 in single precision");
    inverse = data.floats(accessor, what);
    if (inverse.size() < 16 * joints.size())
      fail(what + " are " + std::to_string(inverse.size() / 16) + ", fewer than its " +
           std::to_string(joints.size()) + " joints");
  }
  Joints found;
  for (const json& joint : joints) {
    Eigen::Matrix4d matrix = placements.of(whole(joint, list(scene, "nodes").size(), where + "'s joint"));
    if (!inverse.empty())
      matrix *= Eigen::Map<const Eigen::Matrix4f>(inverse.data() + 16 * found.size()).cast<double>();
    found.push_back(matrix);
  }
  return found;
}

std::vector<double> morph_weights(const json& node, const json& mesh, const std::string& where) {
  const json& chosen = optional(node, "weights").is_null() ? list(mesh, "weights") : list(node, "weights");
  std::vector<double> weights;
  for (const json& weight : chosen) {
    if (!weight.is_number()) fail(where + "'s weights hold " + shown(weight) + ", which is not a number");
    weights.push_back(weight.get<double>());
  }
  const bool any = std::any_of(weights.begin(), weights.end(), [](double weight) { return weight != 0.0; });
  return any ? weights : std::vector<double>{};
}

void morph(const Part& part, const std::vector<double>& weights, const Data& data,
           std::vector<double>& positions) {
  const json& targets = list(part.primitive, "targets");
  if (targets.size() != weights.size()) {
    fail(part.where + " has " + std::to_string(targets.size()) + " morph targets, and its mesh or node has " +
         std::to_string(weights.size()) + " weights");
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const json& accessor = optional(targets[i], "POSITION");
    if (weights[i] == 0.0 || accessor.is_null()) continue;
    const std::vector<float> moved =
        data.floats(accessor.get<std::size_t>(), part.where + "'s morph target " + std::to_string(i));
    if (moved.size() != positions.size())
      fail(part.where + "'s morph targets have another count than its vertices");
    for (std::size_t k = 0; k < positions.size(); ++k)
      positions[k] += weights[i] * static_cast<double>(moved[k]);
  }
}

void apply_skin(const json& scene, const Joints& joints, const Part& part, const Data& data,
                std::vector<double>& positions) {
  const std::size_t vertices = positions.size() / 3;
  Joints sums(vertices, Eigen::Matrix4d::Zero());
  std::vector<double> whole_weight(vertices, 0.0);
  for (std::size_t set = 0;; ++set) {
    const std::string suffix = "_" + std::to_string(set);
    const std::vector<float> numbers = of_set(scene, part, "JOINTS" + suffix, data);
    const std::vector<float> weights = of_set(scene, part, "WEIGHTS" + suffix, data);
    if (set == 0 ? numbers.empty() || weights.empty() : numbers.empty() != weights.empty())
      fail(part.where + " has a skin, and its JOINTS" + suffix + " or WEIGHTS" + suffix + " are missing");
    if (numbers.empty()) break;
    if (numbers.size() != kPerVertex * vertices || weights.size() != kPerVertex * vertices)
      fail(part.where + "'s joints have another count than its vertices");
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto weight = static_cast<double>(weights[i]);
      whole_weight[i / kPerVertex] += weight;
      add_weighted(joints, numbers[i], weight, part, i / kPerVertex, sums[i / kPerVertex]);
    }
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    if (!(whole_weight[i] > 0.0))
      fail(part.where + "'s vertex " + std::to_string(i) + " hangs on no joint of its skin");
    const Eigen::Vector4d place(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2], 1.0);
    const Eigen::Vector4d moved = sums[i] * place / whole_weight[i];
    for (std::size_t k = 0; k < 3; ++k) positions[3 * i + k] = moved[static_cast<Eigen::Index>(k)];
  }
}

}  // namespace tumblesight::sim::gltf
