#include "sim/world/target/glb_writer.hpp"

namespace tumblesight::sim::gltf {
namespace {

constexpr std::size_t kHeaderBytes = 12;  // of a GLB file
constexpr std::size_t kChunkBytes = 8;    // of the header of a chunk

void append(std::string& bytes, std::size_t value) {
  if (value > 0xFFFFFFFFU) refuse("has more than 4 GB of data; simplify it in the modelling tool");
  for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8U * i) & 0xFFU);
}

}  // namespace

std::size_t GlbWriter::add(const void* data, std::size_t size, std::uint64_t component_type, const char* type,
                           std::size_t count) {
  binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
  json& views = scene_["bufferViews"];
  views.push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}});
  binary_.append(static_cast<const char*>(data), size);
  json& accessors = scene_["accessors"];
  accessors.push_back({{"bufferView", views.size() - 1},
                       {"componentType", component_type},
                       {"count", count},
                       {"type", type}});
  return accessors.size() - 1;
}

std::size_t GlbWriter::add_accessor(const std::vector<float>& values, std::uint64_t component_type,
                                    const char* type, std::size_t count) {
  return add(values.data(), values.size() * sizeof(float), component_type, type, count);
}

std::size_t GlbWriter::add_accessor(const std::vector<std::uint32_t>& values, std::uint64_t component_type,
                                    const char* type, std::size_t count) {
  return add(values.data(), values.size() * sizeof(std::uint32_t), component_type, type, count);
}

std::string GlbWriter::bytes() {
  binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
  scene_["buffers"] = json::array({{{"byteLength", binary_.size()}}});
  std::string text = scene_.dump(-1, ' ', true, json::error_handler_t::replace);
  text.append((4 - text.size() % 4) % 4, ' ');
  std::string bytes = "glTF";
  append(bytes, 2);
  append(bytes, kHeaderBytes + 2 * kChunkBytes + text.size() + binary_.size());
  append(bytes, text.size());
  bytes += "JSON" + text;
  append(bytes, binary_.size());
  return bytes + std::string("BIN\0", 4) + binary_;
}

}  // namespace tumblesight::sim::gltf
