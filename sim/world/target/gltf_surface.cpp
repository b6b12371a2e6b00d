#include "sim/world/target/gltf_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "sim/host/text.hpp"
#include "sim/world/target/gltf_data.hpp"
#include "sim/world/target/gltf_draco.hpp"
#include "sim/world/target/gltf_nodes.hpp"
#include "sim/world/target/gltf_pose.hpp"
#include "sim/world/target/mesh_builder.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {
namespace gltf {
namespace {

constexpr std::size_t kMaxVertices = 60'000'000;  // of all parts, each as often as a node repeats it
constexpr double kNoAreaShare = 1e-7;             // of a triangle's longest edge squared: it has no area

std::uint64_t mode_of(const json& primitive) {
  return whole_or(primitive, "mode", kTriangles, 7, "a primitive");
}

std::size_t triangles_of(std::uint64_t mode, std::size_t corners) {
  if (mode < kTriangles) return 0;
  return mode == kTriangles ? corners / 3 : corners - 2;
}

// The corners of a triangle among those of a list of triangles, a strip or a fan.
std::array<std::size_t, 3> corners_of_triangle(std::uint64_t mode, std::size_t i) {
  if (mode == kTriangles) return {3 * i, 3 * i + 1, 3 * i + 2};
  if (mode == kTriangleFan) return {0, i + 1, i + 2};
  return {i, i + 1 + i % 2, i + 2 - i % 2};  // of a strip every second one is turned round
}

bool has_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return 0.5 * (b - a).cross(c - a).norm() > kNoAreaShare * longest;
}

// The numbers of a primitive as the file has them.
struct Shape {
  std::uint64_t mode = kTriangles;
  const std::vector<float>* positions = nullptr;
  const std::vector<std::uint32_t>* listed = nullptr;  // its corners; without: every vertex once

  std::size_t vertices() const { return positions->size() / 3; }
  std::size_t corners() const { return listed == nullptr ? vertices() : listed->size(); }
  std::size_t triangles() const { return triangles_of(mode, corners()); }
  std::size_t vertex(std::size_t corner) const { return listed == nullptr ? corner : (*listed)[corner]; }
};

class Surface {
 public:
  Surface(const File& file, const MeshFileOptions& options)
      : scene_(file.scene), data_(file), placements_(file.scene), builder_(options, "node") {}

  TriangleMesh mesh() {
    const SceneNodes nodes = nodes_of_scene(scene_);
    for (const std::size_t node : nodes.visible) {
      if (scene_["nodes"][node].contains("mesh")) add_node(node);
    }
    if (parts_ == 0) refuse_empty(nodes);
    if (builder_.triangles() == 0) {
      refuse("holds no triangles: its scene has " + std::to_string(parts_) +
             " parts, all of points or lines; export the surface as a triangle mesh");
    }
    check_flat();
    return builder_.finish();
  }

 private:
  [[noreturn]] void refuse_empty(const SceneNodes& nodes) const {
    const std::size_t meshes = list(scene_, "meshes").size();
    if (meshes == 0) fail("its scene holds no parts: the file has no meshes");
    const auto has_mesh = [this](std::size_t node) { return scene_["nodes"][node].contains("mesh"); };
    const auto shown = std::find_if(nodes.visible.begin(), nodes.visible.end(), has_mesh);
    if (shown != nodes.visible.end()) {
      fail("its scene holds no parts: mesh " + scene_["nodes"][*shown]["mesh"].dump() +
           ", which stands in node " + std::to_string(*shown) + ", has no primitives");
    }
    const auto hidden = std::count_if(nodes.hidden.begin(), nodes.hidden.end(), has_mesh);
    if (hidden > 0) {
      refuse("its scene shows no parts: KHR_node_visibility hides all " + std::to_string(hidden) +
             " nodes that have one; make them visible and export it again");
    }
    refuse("its scene holds no parts: none of the " + std::to_string(meshes) +
           " meshes of the file stands in scene " + std::to_string(chosen_scene(scene_)) + ", which has " +
           std::to_string(nodes.visible.size() + nodes.hidden.size()) +
           " nodes; put the parts into this scene and export it again");
  }

  void add_node(std::size_t number) {
    const json& node = scene_["nodes"][number];
    const auto mesh_number = node["mesh"].get<std::size_t>();
    const json& mesh = scene_["meshes"][mesh_number];
    const std::vector<double> weights = morph_weights(node, mesh, "mesh " + std::to_string(mesh_number));
    const std::size_t primitives = list(mesh, "primitives").size();
    for (std::size_t i = 0; i < primitives; ++i) {
      const Part part{mesh, mesh["primitives"][i],
                      "mesh " + std::to_string(mesh_number) + "'s primitive " + std::to_string(i)};
      const Shape shape = shape_of(part, {mesh_number, i});
      check_vertices(part, shape);
      count(shape);
      if (shape.mode >= kTriangles && shape.corners() > 0) add_part(number, part, shape, weights);
    }
  }

  // The positions that morph targets and a skin give; empty if the part has neither.
  std::vector<double> posed(std::size_t number, const Part& part, const Shape& shape,
                            const std::vector<double>& weights) {
    const json& skin = optional(scene_["nodes"][number], "skin");
    if (weights.empty() && skin.is_null()) return {};
    std::vector<double> values(shape.positions->begin(), shape.positions->end());
    if (!weights.empty()) morph(part, weights, data_, values);
    if (!skin.is_null()) apply_skin(scene_, joints(skin.get<std::size_t>()), part, data_, values);
    return values;
  }

  void add_part(std::size_t number, const Part& part, const Shape& shape,
                const std::vector<double>& weights) {
    const std::vector<double> values = posed(number, part, shape, weights);
    // A skin puts its part into the axes of the scene.
    const Eigen::Matrix4d placement =
        scene_["nodes"][number].contains("skin") ? Eigen::Matrix4d::Identity() : placements_.of(number);
    const auto place = [&](std::size_t vertex) -> Eigen::Vector3d {
      Eigen::Vector4d at = Eigen::Vector4d::UnitW();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t value = 3 * vertex + k;
        at[static_cast<Eigen::Index>(k)] =
            values.empty() ? static_cast<double>((*shape.positions)[value]) : values[value];
      }
      return (placement * at).head<3>();
    };
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < shape.vertices(); ++i) last = builder_.add_vertex(place(i), number);
    add_triangles(number, part, shape, placement, last + 1 - static_cast<std::uint32_t>(shape.vertices()),
                  place);
  }

  // `first`: the number of the part's first vertex.
  template <typename Place>
  void add_triangles(std::size_t number, const Part& part, const Shape& shape,
                     const Eigen::Matrix4d& placement, std::uint32_t first, const Place& place) {
    const bool is_flat = is_singular(placement);
    // A node that mirrors its parts turns their triangles round, by the standard.
    const bool is_mirrored = placement.topLeftCorner<3, 3>().determinant() < 0.0;
    const bool is_panel = names_a_panel(material_of(part));
    for (std::size_t i = 0; i < shape.triangles(); ++i) {
      std::array<std::size_t, 3> corners = corners_of_triangle(shape.mode, i);
      for (std::size_t& corner : corners) corner = shape.vertex(corner);
      if (is_flat && !has_area(place(corners[0]), place(corners[1]), place(corners[2])) && flat_++ == 0)
        flat_node_ = number;
      if (is_mirrored) std::swap(corners[1], corners[2]);
      builder_.add_triangle(first + static_cast<std::uint32_t>(corners[0]),
                            first + static_cast<std::uint32_t>(corners[1]),
                            first + static_cast<std::uint32_t>(corners[2]), is_panel);
    }
  }

  std::string material_of(const Part& part) const {
    const json& number = optional(part.primitive, "material");
    if (number.is_null()) return {};
    const json& name = optional(scene_["materials"][number.get<std::size_t>()], "name");
    return name.is_string() ? name.get<std::string>() : std::string();
  }

  const Joints& joints(std::size_t skin) {
    const auto [known, is_new] = joints_.try_emplace(skin);
    if (is_new) known->second = joints_of(scene_, skin, data_, placements_);
    return known->second;
  }

  void count(const Shape& shape) {
    ++parts_;
    triangles_ += shape.triangles();
    vertices_ += shape.vertices();
    if (triangles_ > kMaxTriangles) {
      refuse("has more than " + std::to_string(kMaxTriangles) +
             " triangles, counted as often as its scene repeats them; simplify it in the modelling tool: "
             "100000 show every detail that the sensor can");
    }
    if (vertices_ > kMaxVertices) {
      refuse("has more than " + std::to_string(kMaxVertices) +
             " vertices, counted as often as its scene repeats them; simplify it in the modelling tool");
    }
  }

  // What has no area is left out later, and too much of it is refused. Here the reason is known.
  void check_flat() const {
    if (static_cast<double>(flat_) <= kMaxShareWithoutArea * static_cast<double>(builder_.triangles()))
      return;
    const std::size_t culprit = placements_.flattening(flat_node_);
    const json& node = scene_["nodes"][culprit];
    const bool by_scale = !node.contains("matrix") && node.contains("scale");
    refuse(std::to_string(flat_) + " of " + std::to_string(builder_.triangles()) +
           " triangles have no area, because node " + std::to_string(culprit) + " makes them flat: its " +
           (by_scale ? "scale is " + shown(node["scale"]) : std::string("matrix is singular")) +
           "; correct this node in the modelling tool and export it again");
  }

  // `number`: of the mesh and of its primitive. Numbers are often shared between parts and repeated by nodes;
  // all are read once.
  Shape shape_of(const Part& part, const std::pair<std::size_t, std::size_t>& number) {
    const json& draco = draco_of(part.primitive);
    Shape shape;
    if (draco.is_object()) {
      const auto [known, is_new] = draco_.try_emplace(number);
      if (is_new) known->second = decode_draco(draco, data_);
      shape.positions = &known->second.positions;
      shape.listed = &known->second.corners;
      return shape;
    }
    shape.mode = mode_of(part.primitive);
    shape.positions = &positions_of(part, part.primitive["attributes"]["POSITION"].get<std::size_t>());
    if (part.primitive.contains("indices"))
      shape.listed = &corners_of(part, part.primitive["indices"].get<std::size_t>());
    return shape;
  }

  void check_data(std::size_t accessor, const std::string& what, const char* names) const {
    const json& description = scene_["accessors"][accessor];
    if (!description.contains("bufferView") && !description.contains("sparse"))
      fail(what + " (accessor " + std::to_string(accessor) + ") " + names + " no data");
  }

  const std::vector<float>& positions_of(const Part& part, std::size_t accessor) {
    const auto [known, is_new] = positions_.try_emplace(accessor);
    if (!is_new) return known->second;
    check_data(accessor, part.where + "'s POSITION", "names");
    return known->second = data_.floats(accessor, part.where + "'s POSITION");
  }

  const std::vector<std::uint32_t>& corners_of(const Part& part, std::size_t accessor) {
    const auto [known, is_new] = corners_.try_emplace(accessor);
    if (!is_new) return known->second;
    check_data(accessor, part.where + "'s indices", "name");
    return known->second = data_.wholes(accessor, part.where + "'s indices");
  }

  static void check_vertices(const Part& part, const Shape& shape) {
    if (shape.listed == nullptr || shape.listed->empty()) return;
    const auto largest = std::max_element(shape.listed->begin(), shape.listed->end());
    if (*largest < shape.vertices()) return;
    fail(part.where + " names vertex " + std::to_string(*largest) + " (index " +
         std::to_string(largest - shape.listed->begin()) + "), and it has " +
         std::to_string(shape.vertices()) + " vertices");
  }

  const json& scene_;
  Data data_;
  Placements placements_;
  MeshBuilder builder_;
  std::map<std::size_t, std::vector<float>> positions_;  // by accessor
  std::map<std::size_t, std::vector<std::uint32_t>> corners_;
  std::map<std::pair<std::size_t, std::size_t>, DracoPart> draco_;
  std::map<std::size_t, Joints> joints_;  // by skin
  std::size_t parts_ = 0, triangles_ = 0, vertices_ = 0;
  std::size_t flat_ = 0, flat_node_ = 0;  // triangles without area below singular placements; the first node
};

std::string remark_on(const json& scene) {
  std::vector<bool> stands(list(scene, "meshes").size(), false);
  std::size_t parts = 0, without_triangles = 0, posed = 0, hidden = 0;
  const SceneNodes nodes = nodes_of_scene(scene);
  for (const std::size_t number : nodes.hidden) {
    const json& mesh = optional(scene["nodes"][number], "mesh");
    if (mesh.is_null()) continue;
    stands[mesh.get<std::size_t>()] = true;
    ++hidden;
  }
  for (const std::size_t number : nodes.visible) {
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
  if (hidden > 0)
    text += "The parts of " + counted(hidden, "node") + " are hidden (KHR_node_visibility) and left out. ";
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

TriangleMesh gltf_surface(const std::string& path, const MeshFileOptions& options) {
  return gltf::guarded([&] {
    const gltf::File file = gltf::read_file(path);
    return gltf::Surface(file, options).mesh();
  });
}

}  // namespace tumblesight::sim
