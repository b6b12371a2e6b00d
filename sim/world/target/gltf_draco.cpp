#include "sim/world/target/gltf_draco.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "sim/world/target/mesh_file.hpp"

#ifdef TUMBLESIGHT_HAS_DRACO
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#endif

namespace tumblesight::sim {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kExtension = "KHR_draco_mesh_compression";

struct GltfFile {
  json scene;
  std::string binary;  // the second chunk of a GLB file
};

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::uint32_t u32_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

constexpr std::size_t kHeaderBytes = 12;  // of a GLB file
constexpr std::size_t kChunkBytes = 8;    // of the header of a chunk

GltfFile read_glb(const std::string& bytes) {
  const std::size_t json_bytes = u32_at(bytes, kHeaderBytes);
  std::size_t at = kHeaderBytes + kChunkBytes;
  std::string text = bytes.substr(at, json_bytes);
  text.erase(text.find_last_not_of('\0') + 1);
  GltfFile file{json::parse(text, nullptr, false), {}};
  at += json_bytes;
  if (at + kChunkBytes <= bytes.size()) file.binary = bytes.substr(at + kChunkBytes, u32_at(bytes, at));
  return file;
}

// A member of an object, null if there is none.
const json& member(const json& object, const char* key) {
  static const json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(key);
  return found == object.end() ? kNone : *found;
}

const json& draco_of(const json& primitive) {
  return member(member(primitive, "extensions"), kExtension);
}

bool is_compressed(const json& scene) {
  for (const json& mesh : member(scene, "meshes")) {
    for (const json& primitive : member(mesh, "primitives")) {
      if (draco_of(primitive).is_object()) return true;
    }
  }
  return false;
}

#ifdef TUMBLESIGHT_HAS_DRACO

[[noreturn]] void fail(const std::string& why) {
  throw std::runtime_error(std::string("is compressed with Draco (") + kExtension +
                           ") and cannot be read: " + why + "; export it again, without compression");
}

std::size_t whole(const json& value, const std::string& what) {
  if (!value.is_number_unsigned()) fail(what + " is not a whole number");
  return value.get<std::size_t>();
}

std::size_t whole_or_0(const json& object, const char* key) {
  const json& value = member(object, key);
  return value.is_null() ? 0 : whole(value, key);
}

std::string from_base64(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string::npos) break;  // padding
    group = group << 6 | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xFFU);
  }
  return bytes;
}

std::string bytes_of_buffer(const GltfFile& file, const json& buffer, const fs::path& folder) {
  const json& uri = member(buffer, "uri");
  if (!uri.is_string()) return file.binary;
  const std::string text = uri.get<std::string>();
  const std::string kBase64 = ";base64,";
  const std::size_t data = text.find(kBase64);
  if (text.rfind("data:", 0) == 0 && data != std::string::npos)
    return from_base64(text.substr(data + kBase64.size()));
  const fs::path path = folder / decoded_uri(text);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) fail("its part '" + text + "' is missing");
  return content_of(path);
}

// A GLB file in the making: all data in one buffer.
class Glb {
 public:
  explicit Glb(json scene) : scene_(std::move(scene)) {
    for (const char* list : {"accessors", "bufferViews"}) {
      if (!member(scene_, list).is_array()) scene_[list] = json::array();
    }
  }

  json& scene() { return scene_; }

  // Where the data begins.
  std::size_t add(const void* data, std::size_t size) {
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    const std::size_t at = binary_.size();
    binary_.append(static_cast<const char*>(data), size);
    return at;
  }

  // The number of the accessor.
  template <typename T>
  std::size_t add_accessor(const std::vector<T>& values, int component_type, const char* type,
                           std::size_t count) {
    const std::size_t size = values.size() * sizeof(T);
    scene_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", add(values.data(), size)}, {"byteLength", size}});
    scene_["accessors"].push_back({{"bufferView", scene_["bufferViews"].size() - 1},
                                   {"componentType", component_type},
                                   {"count", count},
                                   {"type", type}});
    return scene_["accessors"].size() - 1;
  }

  std::string bytes() {
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

 private:
  static void append(std::string& bytes, std::size_t value) {
    if (value > 0xFFFFFFFFU) fail("it has more than 4 GB without compression");
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
  }

  json scene_;
  std::string binary_;
};

// Appends the buffers to one, and lets the views of the scene refer to it.
void merge_buffers(const GltfFile& file, const fs::path& folder, Glb& glb,
                   std::vector<std::string>& buffers) {
  std::vector<std::size_t> starts;
  for (const json& buffer : member(file.scene, "buffers")) {
    buffers.push_back(bytes_of_buffer(file, buffer, folder));
    starts.push_back(glb.add(buffers.back().data(), buffers.back().size()));
  }
  for (json& view : glb.scene()["bufferViews"]) {
    if (!view.is_object()) fail("a buffer view is not an object");
    const std::size_t buffer = whole(member(view, "buffer"), "the buffer of a view");
    if (buffer >= buffers.size()) fail("a view is of a buffer that is not there");
    const std::size_t offset = whole_or_0(view, "byteOffset"),
                      size = whole(member(view, "byteLength"), "the length of a view");
    if (offset > buffers[buffer].size() || size > buffers[buffer].size() - offset)
      fail("a view is larger than its buffer");
    view["buffer"] = 0;
    view["byteOffset"] = starts[buffer] + offset;
  }
}

struct DecodedMesh {
  std::vector<float> positions;
  std::vector<std::uint32_t> corners;
};

const draco::PointAttribute& positions_of(const draco::Mesh& mesh, const json& extension) {
  const json& id = member(member(extension, "attributes"), "POSITION");
  const draco::PointAttribute* positions =
      id.is_number_unsigned() ? mesh.GetAttributeByUniqueId(id.get<std::uint32_t>()) : nullptr;
  if (positions == nullptr || positions->num_components() != 3) fail("a part has no positions");
  return *positions;
}

DecodedMesh decode(const char* data, std::size_t size, const json& extension) {
  draco::DecoderBuffer buffer;
  buffer.Init(data, size);
  draco::Decoder decoder;
  auto result = decoder.DecodeMeshFromBuffer(&buffer);
  if (!result.ok()) fail(result.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(result).value();
  if (mesh->num_faces() > kMaxTriangles) fail("it has too many triangles");
  const draco::PointAttribute& positions = positions_of(*mesh, extension);
  DecodedMesh decoded;
  for (draco::PointIndex i(0); i < mesh->num_points(); ++i) {
    std::array<float, 3> place{};
    if (!positions.ConvertValue<float, 3>(positions.mapped_index(i), place.data()))
      fail("a position is not a number");
    decoded.positions.insert(decoded.positions.end(), place.begin(), place.end());
  }
  for (draco::FaceIndex i(0); i < mesh->num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh->face(i)) decoded.corners.push_back(corner.value());
  }
  return decoded;
}

// Positions, triangles and material, without compression. Null if there are no triangles.
json decompressed(const json& primitive, const std::vector<std::string>& buffers, const json& views,
                  Glb& glb) {
  const json& extension = draco_of(primitive);
  const std::size_t number = whole(member(extension, "bufferView"), "the buffer view of a part");
  if (number >= views.size()) fail("a part has no data");
  const json& view = views[number];
  const std::string& buffer = buffers[whole(member(view, "buffer"), "the buffer of a view")];
  const DecodedMesh mesh = decode(buffer.data() + whole_or_0(view, "byteOffset"),
                                  whole(member(view, "byteLength"), "the length of a view"), extension);
  if (mesh.corners.empty()) return nullptr;
  constexpr int kFloat = 5126, kUnsignedInt = 5125, kTriangles = 4;
  const std::size_t positions = glb.add_accessor(mesh.positions, kFloat, "VEC3", mesh.positions.size() / 3);
  const std::size_t corners = glb.add_accessor(mesh.corners, kUnsignedInt, "SCALAR", mesh.corners.size());
  json plain = {{"attributes", {{"POSITION", positions}}}, {"indices", corners}, {"mode", kTriangles}};
  if (primitive.contains("material")) plain["material"] = primitive["material"];
  return plain;
}

// Textures and what moves are of no use for the surface. Materials keep their names.
void keep_the_surface(json& scene) {
  for (const char* list : {"images", "textures", "samplers", "animations", "skins", "cameras", "extensions",
                           "extensionsUsed", "extensionsRequired"})
    scene.erase(list);
  if (scene.contains("materials")) {
    for (json& material : scene["materials"]) {
      const json& name = member(material, "name");
      const std::string kept = name.is_string() ? name.get<std::string>() : "";
      material = {{"name", kept}};
    }
  }
  if (!scene.contains("nodes")) return;
  for (json& node : scene["nodes"]) {
    if (!node.is_object()) continue;
    for (const char* key : {"skin", "camera", "extensions"}) node.erase(key);
  }
}

std::string decompress(const GltfFile& file, const fs::path& folder) {
  Glb glb(file.scene);
  std::vector<std::string> buffers;
  merge_buffers(file, folder, glb, buffers);
  keep_the_surface(glb.scene());
  for (json& mesh : glb.scene()["meshes"]) {
    json plain = json::array();
    for (const json& primitive : member(mesh, "primitives")) {
      if (!draco_of(primitive).is_object()) {
        plain.push_back(primitive);
        continue;
      }
      json part = decompressed(primitive, buffers, member(file.scene, "bufferViews"), glb);
      if (!part.is_null()) plain.push_back(std::move(part));
    }
    mesh = {{"primitives", plain}};
  }
  return glb.bytes();
}

#else

std::string decompress(const GltfFile&, const fs::path&) {
  throw std::runtime_error(
      std::string("is compressed with Draco (") + kExtension +
      "), which this build cannot read; install libdraco-dev, configure and build again, or export the file "
      "without compression");
}

#endif

}  // namespace

std::string without_draco(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".gltf" && extension != ".glb") return {};
  const std::string bytes = content_of(path);
  const GltfFile file =
      extension == ".glb" ? read_glb(bytes) : GltfFile{json::parse(bytes, nullptr, false), {}};
  if (!is_compressed(file.scene)) return {};
  return decompress(file, fs::path(path).parent_path());
}

}  // namespace tumblesight::sim
