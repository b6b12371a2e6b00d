// Parts of glTF files that are compressed with Draco (extension KHR_draco_mesh_compression), as most public
// models of spacecraft are.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/target/gltf_data.hpp"

namespace tumblesight::sim::gltf {

// The extension's object of a primitive; null if the primitive is not compressed.
const json& draco_of(const json& primitive);

struct DracoPart {
  std::vector<float> positions;        // three per vertex
  std::vector<std::uint32_t> corners;  // three per triangle
};

// Throws std::runtime_error that says what is wrong and what to do, without the name of the file.
DracoPart decode_draco(const json& extension, const Data& data);

// One of its other attributes, such as "JOINTS_0": four numbers per vertex. Empty if there is none.
std::vector<float> draco_attribute(const json& extension, const Data& data, const char* name);

}  // namespace tumblesight::sim::gltf
