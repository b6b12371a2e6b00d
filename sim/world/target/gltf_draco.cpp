#include "sim/world/target/gltf_draco.hpp"

#include <array>
#include <memory>
#include <string>

#include "sim/world/target/mesh_file.hpp"

#ifdef TUMBLESIGHT_HAS_DRACO
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#endif

namespace tumblesight::sim::gltf {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";

#ifdef TUMBLESIGHT_HAS_DRACO

[[noreturn]] void fail_draco(const std::string& why) {
  refuse(std::string("is compressed with Draco (") + kExtension + ") and cannot be read: " + why +
         "; export it again, without compression");
}

std::unique_ptr<draco::Mesh> decoded(const json& extension, const Data& data) {
  const Bytes bytes = data.view(optional(extension, "bufferView"), "a compressed part");
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data, bytes.size);
  draco::Decoder decoder;
  auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) fail_draco("the data of a part is damaged");
  std::unique_ptr<draco::Mesh> mesh = std::move(result).value();
  if (mesh->num_faces() > kMaxTriangles) fail_draco("it has too many triangles");
  return mesh;
}

const draco::PointAttribute* attribute_of(const draco::Mesh& mesh, const json& extension, const char* name) {
  const json& id = optional(optional(extension, "attributes"), name);
  return id.is_number_unsigned() ? mesh.GetAttributeByUniqueId(id.get<std::uint32_t>()) : nullptr;
}

template <std::size_t kComponents>
std::vector<float> values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  std::vector<float> values;
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
    std::array<float, kComponents> value{};
    if (!attribute.ConvertValue<float, static_cast<int>(kComponents)>(attribute.mapped_index(i),
                                                                      value.data()))
      fail_draco("a position is not a number");
    values.insert(values.end(), value.begin(), value.end());
  }
  return values;
}

#endif

}  // namespace

const json& draco_of(const json& primitive) {
  return optional(optional(primitive, "extensions"), kExtension);
}

#ifdef TUMBLESIGHT_HAS_DRACO

DracoPart decode_draco(const json& extension, const Data& data) {
  const std::unique_ptr<draco::Mesh> mesh = decoded(extension, data);
  const draco::PointAttribute* positions = attribute_of(*mesh, extension, "POSITION");
  if (positions == nullptr || positions->num_components() != 3) fail_draco("a part has no positions");
  DracoPart part{values_of<3>(*mesh, *positions), {}};
  for (draco::FaceIndex i(0); i < mesh->num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh->face(i)) part.corners.push_back(corner.value());
  }
  return part;
}

std::vector<float> draco_attribute(const json& extension, const Data& data, const char* name) {
  const std::unique_ptr<draco::Mesh> mesh = decoded(extension, data);
  const draco::PointAttribute* attribute = attribute_of(*mesh, extension, name);
  if (attribute == nullptr || attribute->num_components() != 4) return {};
  return values_of<4>(*mesh, *attribute);
}

#else

DracoPart decode_draco(const json&, const Data&) {
  refuse(
      std::string("is compressed with Draco (") + kExtension +
      "), which this build cannot read; install libdraco-dev, configure and build again, or export the file "
      "without compression");
}

std::vector<float> draco_attribute(const json&, const Data&, const char*) {
  return {};
}

#endif

}  // namespace tumblesight::sim::gltf
