#include "sim/world/target/gltf_surface.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "sim/terminal/text.hpp"
#include "sim/world/target/glb_writer.hpp"
#include "sim/world/target/gltf_data.hpp"
#include "sim/world/target/gltf_draco.hpp"
#include "sim/world/target/gltf_nodes.hpp"
#include "sim/world/target/gltf_pose.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {
namespace gltf {
namespace {

constexpr std::size_t kMaxVertices = 60'000'000;  // of all parts, each as often as a node repeats it

std::uint64_t mode_of(const json& primitive) {
  return whole_or(primitive, "mode", kTriangles, 7, "a primitive");
}

std::size_t triangles_of(std::uint64_t mode, std::size_t corners) {
  if (mode < kTriangles) return 0;
  return mode == kTriangles ? corners / 3 : corners - 2;
}

// An accessor of the GLB file.
struct Written {
  std::size_t accessor = 0, count = 0;
  std::uint32_t largest = 0;  // of corners: the largest vertex
  std::size_t largest_at = 0;
};

class Surface {
 public:
  explicit Surface(const File& file) : file_(file), scene_(file.scene), data_(file) {}

  std::string bytes() {
    start_nodes();
    const std::vector<std::size_t> nodes = nodes_of_scene(scene_);
    for (const std::size_t node : nodes) {
      if (scene_["nodes"][node].contains("mesh")) add_node(node);
    }
    if (parts_ == 0) refuse_empty(nodes.size());
    if (triangles_ == 0) {
      refuse("holds no triangles: its scene has " + std::to_string(parts_) +
             " parts, all of points or lines; export the surface as a triangle mesh");
    }
    return glb_.bytes();
  }

 private:
  void start_nodes() {
    json& to = glb_.scene();
    to["scene"] = 0;
    to["scenes"] = json::array({{{"nodes", list(list(scene_, "scenes").at(chosen_scene(scene_)), "nodes")}}});
    for (const json& node : list(scene_, "nodes")) {
      json kept = json::object();
      for (const char* key : {"children", "matrix", "translation", "rotation", "scale"}) {
        if (node.contains(key)) kept[key] = node[key];
      }
      if (kept.contains("matrix")) {
        for (const char* key : {"translation", "rotation", "scale"}) kept.erase(key);
      }
      to["nodes"].push_back(std::move(kept));
    }
    for (const json& material : list(scene_, "materials")) {
      const json& name = optional(material, "name");
      to["materials"].push_back({{"name", name.is_string() ? name : json("")}});
    }
  }

  [[noreturn]] void refuse_empty(std::size_t nodes) const {
    const std::size_t meshes = list(scene_, "meshes").size();
    if (meshes == 0) fail("its scene holds no parts: the file has no meshes");
    refuse("its scene holds no parts: none of the " + std::to_string(meshes) +
           " meshes of the file stands in scene " + std::to_string(chosen_scene(scene_)) + ", which has " +
           std::to_string(nodes) + " nodes; put the parts into this scene and export it again");
  }

  // A part that a skin or morph targets change becomes a mesh of its own.
  void add_node(std::size_t number) {
    const json& node = scene_["nodes"][number];
    const auto mesh_number = node["mesh"].get<std::size_t>();
    const json& mesh = scene_["meshes"][mesh_number];
    const std::vector<double> weights = morph_weights(node, mesh, "mesh " + std::to_string(mesh_number));
    const bool has_skin = node.contains("skin");
    if (weights.empty() && !has_skin) {
      const auto [known, is_new] = meshes_.try_emplace(mesh_number, 0);
      if (is_new) known->second = add_mesh(number, mesh_number, {});
      count(known->second);
      if (!counts_[known->second].is_empty) glb_.scene()["nodes"][number]["mesh"] = known->second;
      return;
    }
    const std::size_t added = add_mesh(number, mesh_number, weights);
    count(added);
    if (counts_[added].is_empty) return;
    if (!has_skin) {
      glb_.scene()["nodes"][number]["mesh"] = added;
      return;
    }
    json& nodes = glb_.scene()["nodes"];
    nodes.push_back({{"mesh", added}});
    glb_.scene()["scenes"][0]["nodes"].push_back(nodes.size() - 1);
  }

  struct Counts {
    std::size_t parts = 0, triangles = 0, vertices = 0;
    bool is_empty = true;
  };

  void count(std::size_t mesh) {
    parts_ += counts_[mesh].parts;
    triangles_ += counts_[mesh].triangles;
    vertices_ += counts_[mesh].vertices;
    if (triangles_ > kMaxTriangles) {
      refuse("has more than " + std::to_string(kMaxTriangles) +
             " triangles, counted as often as its scene repeats them; simplify it in the modelling tool: "
             "100000 show "
             "every detail that the sensor can");
    }
    if (vertices_ > kMaxVertices) {
      refuse("has more than " + std::to_string(kMaxVertices) +
             " vertices, counted as often as its scene repeats them; simplify it in the modelling tool");
    }
  }

  // The number of the mesh in the GLB file.
  std::size_t add_mesh(std::size_t node, std::size_t number, const std::vector<double>& weights) {
    const json& mesh = scene_["meshes"][number];
    json primitives = json::array();
    Counts counts;
    for (std::size_t i = 0; i < list(mesh, "primitives").size(); ++i) {
      const Part part{mesh, mesh["primitives"][i],
                      "mesh " + std::to_string(number) + "'s primitive " + std::to_string(i)};
      ++counts.parts;
      json plain = add_primitive(node, part, weights, counts);
      if (!plain.is_null()) primitives.push_back(std::move(plain));
    }
    counts.is_empty = primitives.empty();
    json& meshes = glb_.scene()["meshes"];
    meshes.push_back({{"primitives", std::move(primitives)}});
    counts_.push_back(counts);
    return counts_.size() - 1;
  }

  // Null if it has no corners.
  json add_primitive(std::size_t node, const Part& part, const std::vector<double>& weights, Counts& counts) {
    const json& draco = draco_of(part.primitive);
    const bool has_pose = !weights.empty() || scene_["nodes"][node].contains("skin");
    std::optional<Written> corners;
    Written positions;
    if (draco.is_object()) {
      DracoPart decoded = decode_draco(draco, data_);
      if (decoded.corners.empty()) return nullptr;
      if (has_pose) place(node, part, weights, decoded.positions);
      positions = add_positions(decoded.positions);
      corners = add_corners(decoded.corners);
    } else {
      const auto accessor = part.primitive["attributes"]["POSITION"].get<std::size_t>();
      positions = has_pose ? add_placed(node, part, weights, accessor) : positions_of(part, accessor);
      if (part.primitive.contains("indices"))
        corners = corners_of(part, part.primitive["indices"].get<std::size_t>());
    }
    check_corners(part, positions, corners);
    const std::uint64_t mode = draco.is_object() ? kTriangles : mode_of(part.primitive);
    counts.vertices += positions.count;
    counts.triangles += triangles_of(mode, corners ? corners->count : positions.count);
    json plain = {{"attributes", {{"POSITION", positions.accessor}}}, {"mode", mode}};
    if (corners) plain["indices"] = corners->accessor;
    if (part.primitive.contains("material")) plain["material"] = part.primitive["material"];
    return plain;
  }

  void place(std::size_t node, const Part& part, const std::vector<double>& weights,
             std::vector<float>& positions) {
    if (!weights.empty()) morph(part, weights, data_, positions);
    if (scene_["nodes"][node].contains("skin")) apply_skin(scene_, node, part, data_, positions);
  }

  Written add_placed(std::size_t node, const Part& part, const std::vector<double>& weights,
                     std::size_t accessor) {
    std::vector<float> positions = read_positions(part, accessor);
    place(node, part, weights, positions);
    return add_positions(positions);
  }

  std::vector<float> read_positions(const Part& part, std::size_t accessor) const {
    const json& description = scene_["accessors"][accessor];
    if (!description.contains("bufferView") && !description.contains("sparse"))
      fail(part.where + "'s POSITION (accessor " + std::to_string(accessor) + ") names no data");
    return data_.floats(accessor, part.where + "'s POSITION");
  }

  // Accessors are often shared between parts; each is written once.
  const Written& positions_of(const Part& part, std::size_t accessor) {
    const auto [known, is_new] = positions_.try_emplace(accessor);
    if (is_new) known->second = add_positions(read_positions(part, accessor));
    return known->second;
  }

  const Written& corners_of(const Part& part, std::size_t accessor) {
    const auto [known, is_new] = corners_.try_emplace(accessor);
    if (!is_new) return known->second;
    const json& description = scene_["accessors"][accessor];
    if (!description.contains("bufferView") && !description.contains("sparse"))
      fail(part.where + "'s indices (accessor " + std::to_string(accessor) + ") name no data");
    return known->second = add_corners(data_.wholes(accessor, part.where + "'s indices"));
  }

  Written add_positions(const std::vector<float>& values) {
    return {glb_.add_accessor(values, kFloat, "VEC3", values.size() / 3), values.size() / 3, 0, 0};
  }

  Written add_corners(const std::vector<std::uint32_t>& values) {
    const auto largest = std::max_element(values.begin(), values.end());
    return {glb_.add_accessor(values, kUnsignedInt, "SCALAR", values.size()), values.size(),
            largest == values.end() ? 0 : *largest, static_cast<std::size_t>(largest - values.begin())};
  }

  static void check_corners(const Part& part, const Written& positions,
                            const std::optional<Written>& corners) {
    if (!corners || corners->largest < positions.count) return;
    fail(part.where + " names vertex " + std::to_string(corners->largest) + " (index " +
         std::to_string(corners->largest_at) + "), and it has " + std::to_string(positions.count) +
         " vertices");
  }

  const File& file_;
  const json& scene_;
  Data data_;
  GlbWriter glb_;
  std::map<std::size_t, std::size_t> meshes_;  // numbers in the file to those in the GLB file
  std::map<std::size_t, Written> positions_, corners_;
  std::vector<Counts> counts_;  // of each mesh in the GLB file
  std::size_t parts_ = 0, triangles_ = 0, vertices_ = 0;
};

std::string remark_on(const json& scene) {
  std::vector<bool> stands(list(scene, "meshes").size(), false);
  std::size_t parts = 0, without_triangles = 0, posed = 0;
  for (const std::size_t number : nodes_of_scene(scene)) {
    const json& node = scene["nodes"][number];
    if (!node.contains("mesh")) continue;
    const auto mesh = node["mesh"].get<std::size_t>();
    stands[mesh] = true;
    if (node.contains("skin") || !morph_weights(node, scene["meshes"][mesh], "a mesh").empty()) ++posed;
    for (const json& primitive : list(scene["meshes"][mesh], "primitives")) {
      ++parts;
      if (mode_of(primitive) < kTriangles) ++without_triangles;
    }
  }
  const auto of = [](std::size_t some, std::size_t all) {
    return std::to_string(some) + " of " + std::to_string(all);
  };
  const auto unused = static_cast<std::size_t>(std::count(stands.begin(), stands.end(), false));
  const std::size_t scenes = list(scene, "scenes").size();
  std::string text;
  if (without_triangles > 0)
    text += of(without_triangles, parts) +
            " parts of the file are points or lines and left out: no ray hits them. ";
  if (unused > 0) text += of(unused, stands.size()) + " meshes of the file stand in no node of its scene. ";
  if (scenes > 1) text += "Only scene " + of(chosen_scene(scene), scenes) + " is read, the file's default. ";
  if (posed > 0) text += "The skins and morph targets of " + counted(posed, "node") + " are applied. ";
  if (!list(scene, "animations").empty())
    text += "Animations are left out: the parts stand as their nodes put them. ";
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace
}  // namespace gltf

bool is_gltf_name(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".gltf" || ending == ".glb";
}

std::string gltf_remark(const std::string& path) {
  if (!is_gltf_name(path)) return {};
  return gltf::guarded([&] { return gltf::remark_on(gltf::read_file(path).scene); });
}

std::string gltf_surface(const std::string& path) {
  return gltf::guarded([&] {
    const gltf::File file = gltf::read_file(path);
    return gltf::Surface(file).bytes();
  });
}

}  // namespace tumblesight::sim
