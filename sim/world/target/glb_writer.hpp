// A GLB file in the making: all data in one buffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/world/target/gltf_file.hpp"

namespace tumblesight::sim::gltf {

class GlbWriter {
 public:
  json& scene() { return scene_; }

  // The number of the accessor.
  std::size_t add_accessor(const std::vector<float>& values, std::uint64_t component_type, const char* type,
                           std::size_t count);
  std::size_t add_accessor(const std::vector<std::uint32_t>& values, std::uint64_t component_type,
                           const char* type, std::size_t count);

  // The whole file. Throws std::runtime_error if it has more than 4 GB.
  std::string bytes();

 private:
  std::size_t add(const void* data, std::size_t size, std::uint64_t component_type, const char* type,
                  std::size_t count);

  json scene_ = {{"asset", {{"version", "2.0"}}},
                 {"accessors", json::array()},
                 {"bufferViews", json::array()},
                 {"meshes", json::array()},
                 {"nodes", json::array()}};
  std::string binary_;
};

}  // namespace tumblesight::sim::gltf
