#include "sim/world/target/mesh_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#ifdef TUMBLESIGHT_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace tumblesight::sim {

namespace {

// A triangle with an area below this share of its longest edge squared counts as one without area: the limit
// of single precision.
constexpr double kMinAreaShare = 1e-7;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error("mesh '" + path + "': " + why);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// Assimp reads more formats. Only these are supported and tested with damaged files (tests/fuzz); damaged
// files of other formats can crash it.
void check_format(const std::string& path) {
  const std::string extension = extension_of(path);
  for (const char* known : {".stl", ".obj", ".gltf", ".glb"}) {
    if (extension == known) return;
  }
  refuse(path, "cannot be read: its name must end in .stl, .obj, .gltf or .glb; export it as one of these");
}

void check_readable(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    refuse(path, "no such file; check the path given with --mesh");
  }
  if (!std::filesystem::is_regular_file(status)) {
    refuse(path, "is not a file; --mesh takes one STL, OBJ, glTF or GLB file");
  }
  if (std::filesystem::file_size(path, error) == 0 && !error) {
    refuse(path, "the file is empty (0 bytes)");
  }
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) {
    refuse(path, "cannot be opened; check its permissions");
  }
  std::fclose(file);
}

void check_start(const std::string& path) {
  const std::string extension = extension_of(path);
  try {
    if (extension == ".glb") check_glb(path);
    if (extension == ".gltf") check_gltf(path);
  } catch (const std::exception& error) {
    refuse(path, error.what());
  }
}

void check_vertices(const std::string& path, const std::vector<Eigen::Vector3f>& vertices) {
  const auto bad = [](const Eigen::Vector3f& v) { return !v.allFinite(); };
  const auto first = std::find_if(vertices.begin(), vertices.end(), bad);
  if (first == vertices.end()) {
    return;
  }
  refuse(path, std::to_string(std::count_if(first, vertices.end(), bad)) + " of " +
                   std::to_string(vertices.size()) + " vertices are not finite, the first is vertex " +
                   std::to_string(first - vertices.begin()) + " (" + number(first->x()) + ", " +
                   number(first->y()) + ", " + number(first->z()) + "); repair the mesh and export it again");
}

// Gives vertices at exactly the same place the same index. (The step of Assimp joins within a tolerance in
// the unit of the file, which can make small triangles degenerate, and treats not-a-number as equal to
// anything.)
void join_equal_vertices(TriangleMesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> index_at;
  std::vector<std::uint32_t> joined;
  std::vector<Eigen::Vector3f> places;
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m) {
    const auto next = static_cast<std::uint32_t>(places.size());
    const auto [entry, is_new] = index_at.try_emplace({v.x(), v.y(), v.z()}, next);
    if (is_new) {
      places.push_back(v);
    }
    joined.push_back(entry->second);
  }
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      corner = joined[corner];
    }
  }
  mesh.vertices_trf_m = std::move(places);
}

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Eigen::Vector3d a = mesh.vertices_trf_m[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices_trf_m[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices_trf_m[triangle[2]].cast<double>();
  const double longest_squared =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return 0.5 * (b - a).cross(c - a).norm() > kMinAreaShare * longest_squared;
}

void check_triangles(const std::string& path, const TriangleMesh& mesh) {
  std::size_t bad = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!has_area(mesh, mesh.triangles[i])) {
      first = bad == 0 ? i : first;
      ++bad;
    }
  }
  if (bad > 0) {
    refuse(path, std::to_string(bad) + " of " + std::to_string(mesh.triangles.size()) +
                     " triangles have no area, the first is triangle " + std::to_string(first) +
                     "; remove degenerate faces in the modelling tool and export it again");
  }
}

void check_radius(const std::string& path, const TriangleMesh& mesh, double scale) {
  const double radius = mesh.radius_m();
  const std::string measured = "its farthest vertex is " + number(radius) + " m from the origin";
  const std::string advice =
      "; the unit of the file is probably not the metre: give its length in metres with --mesh-scale"
      " (now " +
      number(scale) + ", 0.001 for millimetres)";
  if (radius > kMaxMeshRadius_m) {
    refuse(path, measured + ", at most " + number(kMaxMeshRadius_m) + " m are supported" + advice +
                     ", or the mesh is not centred on its origin");
  }
  if (radius < kMinMeshRadius_m) {
    refuse(path, measured + ", at least " + number(kMinMeshRadius_m) + " m are needed" + advice);
  }
}

#ifdef TUMBLESIGHT_HAS_ASSIMP

// Rotation from the axes of the file to the TRF.
Eigen::Matrix3d axes_trf_file(MeshUp up) {
  if (up == MeshUp::kZ) {
    return Eigen::Matrix3d::Identity();
  }
  Eigen::Matrix3d axes;
  axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return axes;
}

// Whether the name of its material says so. The names of nodes are lost when their transforms are applied.
bool is_named_panel(const aiMaterial& material) {
  std::string name = material.GetName().C_Str();
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name.find("panel") != std::string::npos || name.find("solar") != std::string::npos;
}

void append_faces(const aiMesh& part, const MeshFileOptions& options, TriangleMesh& mesh) {
  const Eigen::Matrix3d to_trf_m = options.scale * axes_trf_file(options.up);
  const auto offset = static_cast<std::uint32_t>(mesh.vertices_trf_m.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    mesh.vertices_trf_m.push_back((to_trf_m * Eigen::Vector3d(v.x, v.y, v.z)).cast<float>());
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices == 3) {
      mesh.triangles.push_back(
          {offset + face.mIndices[0], offset + face.mIndices[1], offset + face.mIndices[2]});
    }
  }
}

TriangleMesh import(const std::string& path, const MeshFileOptions& options) {
  Assimp::Importer importer;
  // Only the surface is needed. Points and lines are sorted into separate meshes and left out: no ray hits
  // them.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                  aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                  aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  importer.SetPropertyBool(AI_CONFIG_PP_PTV_KEEP_HIERARCHY, false);
  const unsigned steps = aiProcess_Triangulate | aiProcess_RemoveComponent | aiProcess_PreTransformVertices |
                         aiProcess_SortByPType | aiProcess_ValidateDataStructure;
  const aiScene* scene = nullptr;
  try {
    scene = importer.ReadFile(path, steps);
  } catch (const std::exception& error) {  // for instance out of memory
    refuse(path, std::string("cannot be read: ") + error.what());
  }
  if (scene == nullptr || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0U) {
    refuse(path, std::string("cannot be read as STL, OBJ, glTF or GLB: ") + importer.GetErrorString());
  }
  TriangleMesh mesh;
  mesh.name = path;
  bool named = false;  // a part is named as a panel
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    if ((scene->mMeshes[i]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0U) {
      append_faces(*scene->mMeshes[i], options, mesh);
      const bool panel = is_named_panel(*scene->mMaterials[scene->mMeshes[i]->mMaterialIndex]);
      named = named || panel;
      mesh.is_panel.resize(mesh.triangles.size(), panel ? 1 : 0);
    }
  }
  if (!named) mesh.is_panel.clear();
  return mesh;
}

#else

TriangleMesh import(const std::string& path, const MeshFileOptions&) {
  refuse(
      path,
      "this build has no Assimp and reads no mesh files; install libassimp-dev, configure and build again");
}

#endif

}  // namespace

TriangleMesh load_mesh_file(const std::string& path, const MeshFileOptions& options) {
  if (!std::isfinite(options.scale) || options.scale <= 0.0) {
    refuse(path, "the scale is " + number(options.scale) + ", it must be positive; correct --mesh-scale");
  }
  check_readable(path);
  check_format(path);
  check_start(path);
  TriangleMesh mesh = import(path, options);
  if (mesh.triangles.empty()) {
    refuse(path, "holds no triangles; export the surface as a triangle mesh");
  }
  check_vertices(path, mesh.vertices_trf_m);
  join_equal_vertices(mesh);
  check_triangles(path, mesh);
  check_radius(path, mesh, options.scale);
  return mesh;
}

MeshUp mesh_up_from(const std::string& name) {
  if (name == "y") {
    return MeshUp::kY;
  }
  if (name == "z") {
    return MeshUp::kZ;
  }
  throw std::invalid_argument("mesh up axis '" + name + "' is unknown; it must be y or z");
}

}  // namespace tumblesight::sim
