#include "sim/world/target/targets.hpp"

#include <stdexcept>

#include "sim/world/target/magellan.hpp"
#include "sim/world/target/near_shoemaker.hpp"
#include "sim/world/target/sacd_aquarius.hpp"

namespace tumblesight::sim {

namespace {

struct Inertia {
  double xx, yy, zz, xy, xz,
      yz;  // kg m^2, elements of the tensor (products of inertia with their minus sign)
};

struct Target {
  const char* name;
  TriangleMesh (*make)();
  Inertia inertia;
};

// The paper's (X, Y, Z) of Aquarius are our (x, z, -y).
constexpr Inertia kAquariusInertia = {2644.24, 3086.41, 1329.64, 2.10, 972.97, -11.49};

constexpr Target kTargets[] = {
    {"near_shoemaker", make_near_shoemaker, {372.38, 372.45, 316.17, -2.86, -2.95, -4.42}},
    {"magellan", make_magellan, {3266.61, 4772.03, 2897.59, 2.62, 36.17, -42.65}},
    {"sacd_aquarius", make_sacd_aquarius, kAquariusInertia},
    {"sacd_aquarius_stowed", make_sacd_aquarius_stowed, kAquariusInertia}};

const Target& find(const std::string& name) {
  std::string known;
  for (const Target& target : kTargets) {
    if (name == target.name) {
      return target;
    }
    known += known.empty() ? target.name : std::string(", ") + target.name;
  }
  throw std::invalid_argument("target '" + name + "' is unknown; the targets are: " + known);
}

}  // namespace

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const Target& target : kTargets) {
    names.emplace_back(target.name);
  }
  return names;
}

TriangleMesh target_by_name(const std::string& name) {
  return find(name).make();
}

Eigen::Matrix3d inertia_kg_m2(const std::string& target) {
  const Inertia& i = find(target).inertia;
  Eigen::Matrix3d tensor;
  tensor << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  return tensor;
}

}  // namespace tumblesight::sim
