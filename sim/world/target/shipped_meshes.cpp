#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

struct ShippedMeshRow {
  const char* target;
  TriangleMesh (*make)();
};

constexpr ShippedMeshRow kShippedMeshes[] = {
    {"near_shoemaker", make_near_shoemaker},
    {"magellan", make_magellan},
    {"sacd_aquarius", make_sacd_aquarius},
    {"sacd_aquarius_stowed", make_sacd_aquarius_stowed},
};

}  // namespace

std::optional<TriangleMesh> shipped_mesh(const std::string& target) {
  for (const ShippedMeshRow& row : kShippedMeshes)
    if (target == row.target) return row.make();
  return std::nullopt;
}

}  // namespace tumblesight::sim
