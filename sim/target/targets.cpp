#include "sim/target/targets.hpp"

#include <stdexcept>

#include "sim/target/near_shoemaker.hpp"

namespace tumblesight::sim {

namespace {

struct Target {
  const char* name;
  TriangleMesh (*make)();
};

constexpr Target kTargets[] = {{"near_shoemaker", make_near_shoemaker}};

}  // namespace

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const Target& target : kTargets) {
    names.emplace_back(target.name);
  }
  return names;
}

TriangleMesh target_by_name(const std::string& name) {
  std::string known;
  for (const Target& target : kTargets) {
    if (name == target.name) {
      return target.make();
    }
    known += known.empty() ? target.name : std::string(", ") + target.name;
  }
  throw std::invalid_argument("target '" + name + "' is unknown; the targets are: " + known);
}

}  // namespace tumblesight::sim
