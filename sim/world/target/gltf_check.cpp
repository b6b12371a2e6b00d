#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/world/target/gltf_data.hpp"
#include "sim/world/target/gltf_file.hpp"
#include "sim/world/target/gltf_nodes.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {
namespace gltf {
namespace {

constexpr std::uint64_t kMaxElements = 100'000'000;

using Counts = std::vector<std::uint64_t>;  // elements per accessor

Counts accessor_counts(const json& file) {
  Counts counts;
  for (const json& accessor : list(file, "accessors")) {
    const std::string where = "accessor " + std::to_string(counts.size());
    counts.push_back(whole(member(accessor, "count", where), kMaxElements, where + "'s count"));
  }
  return counts;
}

std::uint64_t count_of(const json& accessor, const Counts& counts, const std::string& where) {
  return counts[whole(accessor, counts.size(), where)];
}

// What changes the surface and is not read.
struct UnreadExtension {
  const char* name;
  const char* remedy;
};
constexpr UnreadExtension kUnread[] = {
    {"EXT_meshopt_compression", "is compressed with meshoptimizer; export it without compression"},
    {"KHR_meshopt_compression", "is compressed with meshoptimizer; export it without compression"},
    {"EXT_mesh_gpu_instancing", "repeats its parts by instancing; export it with every part written out"},
};

// What a file may require and is still read as it is meant: it is applied, or its surface does not depend on
// it. Positions in whole numbers (KHR_mesh_quantization) are refused where they are.
constexpr const char* kReadPrefixes[] = {"KHR_draco_mesh_compression",
                                         "KHR_mesh_quantization",
                                         "KHR_node_visibility",
                                         "KHR_materials_",
                                         "KHR_texture_",
                                         "EXT_texture_",
                                         "MSFT_texture_dds",
                                         "KHR_lights_",
                                         "EXT_lights_",
                                         "KHR_xmp",
                                         "KHR_animation_pointer"};

bool is_read(const std::string& extension) {
  return std::any_of(std::begin(kReadPrefixes), std::end(kReadPrefixes),
                     [&](const char* prefix) { return extension.rfind(prefix, 0) == 0; });
}

[[noreturn]] void refuse_unread(const UnreadExtension& extension) {
  refuse(std::string("uses ") + extension.name + ", which is not read: it " + extension.remedy);
}

// Some exporters forget to declare an extension that they use.
void check_undeclared(const json& file, const char* key) {
  for (const json& object : list(file, key)) {
    const json& extensions = optional(object, "extensions");
    if (extensions.is_null()) continue;
    for (const UnreadExtension& unread : kUnread) {
      if (!optional(extensions, unread.name).is_null()) refuse_unread(unread);
    }
  }
}

void check_extensions(const json& file) {
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    for (const json& used : list(file, key)) {
      for (const UnreadExtension& unread : kUnread) {
        if (used == unread.name) refuse_unread(unread);
      }
    }
  }
  for (const char* key : {"nodes", "bufferViews"}) check_undeclared(file, key);
  for (const json& required : list(file, "extensionsRequired")) {
    if (!required.is_string())
      fail("\"extensionsRequired\" holds " + shown(required) + ", which is not a name");
    if (is_read(required.get_ref<const std::string&>())) continue;
    refuse(
        "requires the extension " + shown_text(required.get_ref<const std::string&>()) +
        ", which is not read: its surface could be another one without it; export it without this extension. "
        "Read are KHR_draco_mesh_compression, KHR_node_visibility and extensions for materials, textures and "
        "lights");
  }
}

const json& accessor_at(const json& file, const json& number) {
  return list(file, "accessors")[number.get<std::size_t>()];
}

void check_type(const json& accessor, const char* expected, const std::string& where) {
  const json& type = member(accessor, "type", where);
  if (type != expected) fail(where + " is " + shown(type) + ", not " + expected);
}

std::uint64_t component_type(const json& accessor, const std::string& where) {
  const std::uint64_t type =
      whole(member(accessor, "componentType", where), kMaxElements, where + "'s componentType");
  if (bytes_of(type) == 0)
    fail(where + "'s componentType is " + std::to_string(type) + ", which glTF does not have");
  return type;
}

// Of a primitive or of one of its morph targets.
void check_positions(const json& accessor, const std::string& where) {
  check_type(accessor, "VEC3", where);
  if (component_type(accessor, where) == kFloat) return;
  refuse(
      "has positions in whole numbers (KHR_mesh_quantization), which are not read; export it without "
      "quantization");
}

void check_indices(const json& accessor, const std::string& where) {
  check_type(accessor, "SCALAR", where);
  const std::uint64_t type = component_type(accessor, where);
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
    fail(where + "'s componentType is " + std::to_string(type) + ", not an unsigned whole number's");
  }
}

// By primitive mode: points, lines, line loop, line strip, triangles, triangle strip, triangle fan.
constexpr std::array<std::uint64_t, 7> kMinCorners{1, 2, 2, 2, 3, 3, 3};

void check_corners(const json& primitive, std::uint64_t corners, const std::string& where) {
  const std::uint64_t mode =
      whole(primitive.value("mode", json(kTriangles)), kMinCorners.size(), where + "'s mode");
  if (corners < kMinCorners[mode]) {
    fail(where + " of mode " + std::to_string(mode) + " has " + std::to_string(corners) +
         " corners, fewer than " + std::to_string(kMinCorners[mode]));
  }
  if (mode == kTriangles && corners % 3 != 0) {
    fail(where + " has " + std::to_string(corners) + " corners, which are no whole number of triangles");
  }
}

void check_targets(const json& file, const json& primitive, std::uint64_t vertices, const Counts& counts,
                   const std::string& where) {
  std::size_t number = 0;
  for (const json& target : list(primitive, "targets")) {
    const std::string name = where + "'s morph target " + std::to_string(number++);
    const json& moved = optional(target, "POSITION");
    if (moved.is_null()) continue;
    if (count_of(moved, counts, name) != vertices) fail(name + " has another count than its vertices");
    check_positions(accessor_at(file, moved), name);
  }
}

void check_primitive(const json& file, const json& primitive, const Counts& counts,
                     const std::string& where) {
  const json& attributes = member(primitive, "attributes", where);
  const json& positions = member(attributes, "POSITION", where + "'s attributes");
  const std::uint64_t vertices = count_of(positions, counts, where + "'s POSITION");
  check_positions(accessor_at(file, positions), where + "'s POSITION");
  for (const auto& [name, accessor] : attributes.items()) {
    if (count_of(accessor, counts, where + "'s attribute") != vertices) {
      fail(where + " has attributes of different counts");
    }
  }
  std::uint64_t corners = vertices;
  const auto indices = primitive.find("indices");
  if (indices != primitive.end()) {
    corners = count_of(*indices, counts, where + "'s indices");
    check_indices(accessor_at(file, *indices), where + "'s indices");
  }
  check_corners(primitive, corners, where);
  (void)whole_or(primitive, "material", 0, list(file, "materials").size(), where);
  check_targets(file, primitive, vertices, counts, where);
}

void check_scene(const json& file) {
  const json& version = member(member(file, "asset", "its JSON"), "version", "its asset");
  if (!version.is_string() || version.get_ref<const std::string&>().rfind("2.", 0) != 0)
    fail("it is not glTF 2");
  check_extensions(file);
  const Counts counts = accessor_counts(file);
  std::size_t mesh_number = 0;
  for (const json& mesh : list(file, "meshes")) {
    const std::string where = "mesh " + std::to_string(mesh_number++);
    std::size_t number = 0;
    if (!mesh.is_object()) fail(where + " is not an object");
    for (const json& primitive : list(mesh, "primitives")) {
      check_primitive(file, primitive, counts, where + "'s primitive " + std::to_string(number++));
    }
  }
  check_nodes(file);
}

}  // namespace
}  // namespace gltf

void check_gltf(const std::string& path) {
  gltf::guarded([&] { gltf::check_scene(gltf::read_gltf(path).scene); });
}

void check_glb(const std::string& path) {
  gltf::guarded([&] { gltf::check_scene(gltf::read_glb(path).scene); });
}

}  // namespace tumblesight::sim
