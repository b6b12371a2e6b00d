#include "sim/world/target/mesh_file.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/host/input_file.hpp"
#include "sim/world/target/content_kind.hpp"
#include "sim/world/target/file_lines.hpp"
#include "sim/world/target/gltf_surface.hpp"
#include "sim/world/target/obj_file.hpp"
#include "sim/world/target/ply_file.hpp"
#include "sim/world/target/stl_file.hpp"

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
  return in_lower_case(std::filesystem::path(path).extension().string());
}

// What turns a file of another format into one that is read.
struct OtherFormat {
  const char* extension;
  const char* name;
  const char* remedy;
};
constexpr const char* kByBlender = "open it in Blender and use File > Export > glTF 2.0 or STL";
constexpr const char* kByCad =
    "open it in FreeCAD or CAD Assistant and export it as STL or glTF, with an angular deflection of a few "
    "degrees";
constexpr OtherFormat kOtherFormats[] = {
    {".fbx", "FBX", kByBlender},
    {".dae", "COLLADA", kByBlender},
    {".3ds", "3DS", kByBlender},
    {".blend", "Blender", kByBlender},
    {".x3d", "X3D", kByBlender},
    {".wrl", "VRML", kByBlender},
    {".usd", "USD", kByBlender},
    {".usda", "USD", kByBlender},
    {".usdc", "USD", kByBlender},
    {".usdz", "USD", kByBlender},
    {".abc", "Alembic", kByBlender},
    {".max", "3ds Max", "export it from 3ds Max as glTF or STL"},
    {".lwo", "LightWave", "export it from LightWave as OBJ or STL"},
    {".3mf", "3MF", "open it in a slicer or in FreeCAD and export it as STL"},
    {".amf", "AMF", "open it in a slicer or in FreeCAD and export it as STL"},
    {".off", "OFF", "open it in MeshLab and use File > Export Mesh As > STL or PLY"},
    {".step", "STEP", kByCad},
    {".stp", "STEP", kByCad},
    {".iges", "IGES", kByCad},
    {".igs", "IGES", kByCad},
    {".brep", "BREP", kByCad},
    {".fcstd", "FreeCAD", kByCad},
    {".dxf", "DXF", kByCad},
    {".dwg", "DWG", "export it from the CAD program as STL"},
    {".sldprt", "SolidWorks", "export it from SolidWorks as STL"},
    {".sldasm", "SolidWorks", "export it from SolidWorks as STL"},
    {".catpart", "CATIA", "export it from CATIA as STL"},
    {".catproduct", "CATIA", "export it from CATIA as STL"},
    {".ipt", "Inventor", "export it from Inventor as STL"},
    {".iam", "Inventor", "export it from Inventor as STL"},
    {".prt", "part", "export it from the CAD program as STL"},
    {".skp", "SketchUp", "export it from SketchUp as STL or glTF"},
    {".pcd", "point cloud", "make a surface of it in CloudCompare or MeshLab and export this as PLY"},
    {".las", "point cloud", "make a surface of it in CloudCompare or MeshLab and export this as PLY"},
    {".xyz", "point cloud", "make a surface of it in CloudCompare or MeshLab and export this as PLY"},
    {".zip", "archive", "unpack it and give the mesh in it"},
    {".gz", "archive", "unpack it and give the mesh in it"},
};

// The files that are supported and tested with damaged content (tests/fuzz).
void check_format(const std::string& path) {
  const std::string extension = extension_of(path);
  for (const char* known : {".stl", ".obj", ".ply", ".gltf", ".glb"}) {
    if (extension == known) return;
  }
  const std::string start = "cannot be read: its name must end in .stl, .obj, .ply, .gltf or .glb; ";
  for (const OtherFormat& other : kOtherFormats) {
    if (extension == other.extension)
      refuse(path, start + other.name + " files are not read: " + other.remedy);
  }
  refuse(path, start + "export it as one of these");
}

void check_readable(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    refuse(path, "no such file; check its path");
  }
  if (!std::filesystem::is_regular_file(status)) {
    refuse(path, "is not a file; give one STL, OBJ, PLY, glTF or GLB file");
  }
  if (std::filesystem::file_size(path, error) == 0 && !error) {
    refuse(path, "the file is empty (0 bytes); export it again");
  }
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) {
    refuse(path, "cannot be opened; check its permissions");
  }
  std::fclose(file);
}

void check_start(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".glb") check_glb(path);
  if (extension == ".gltf") check_gltf(path);
}

// 5,000,000 triangles take 250 MB in binary STL and about 1.4 GB in text.
constexpr InputKind kMesh{"mesh", std::uint64_t{2} << 30U};

TriangleMesh read_by_format(const std::string& path, const MeshFileOptions& options) {
  const std::string extension = extension_of(path);
  if (extension == ".glb" || extension == ".gltf") {
    check_start(path);
    return gltf_surface(path, options);
  }
  const std::string content = read_text(path, kMesh);
  const std::string_view bytes = without_byte_order_mark(content);
  const std::string other = other_content(bytes, extension);
  if (!other.empty()) throw std::runtime_error("cannot be read: it is " + other);
  if (extension == ".obj") return read_obj(bytes, path, options);
  if (extension == ".ply") return read_ply(bytes, options);
  return read_stl(bytes, options);
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

// Sizes that no unit makes a spacecraft of would leave the range of single precision in what follows.
constexpr double kLargestExtent_m = 1e9, kSmallestExtent_m = 1e-9;

void check_extent(const std::string& path, const std::vector<Eigen::Vector3f>& vertices, double scale) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : vertices) box.extend(vertex.cast<double>());
  const double size_m = box.sizes().maxCoeff();
  const double farthest_m = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const std::string remedy =
      "; give the unit of the file with --mesh-scale (now " + number(scale) + "), or repair the mesh";
  if (farthest_m > kLargestExtent_m)
    refuse(path, "its farthest vertex is " + number(farthest_m) + " m from the origin, at most " +
                     number(kLargestExtent_m) + " m are read" + remedy);
  if (size_m < kSmallestExtent_m)
    refuse(path, "its surface is " + number(size_m) + " m long, at least " + number(kSmallestExtent_m) +
                     " m are needed" + remedy);
}

// For each vertex the first one at exactly the same place.
std::vector<std::uint32_t> first_at_same_place(const std::vector<Eigen::Vector3f>& vertices) {
  const auto key = [&vertices](std::uint32_t i) {
    return std::array<float, 3>{vertices[i].x(), vertices[i].y(), vertices[i].z()};
  };
  std::vector<std::uint32_t> sorted(vertices.size());
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&key](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool repeated = i > 0 && key(sorted[i]) == key(sorted[i - 1]);
    first[sorted[i]] = repeated ? first[sorted[i - 1]] : sorted[i];
  }
  return first;
}

// Gives vertices at exactly the same place the same index, and leaves out those of no triangle, which would
// count for the radius.
void join_equal_vertices(TriangleMesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_same_place(mesh.vertices_trf_m);
  std::vector<std::uint8_t> used(first.size(), 0);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) used[first[corner]] = 1;
  }
  std::vector<std::uint32_t> index(first.size(), 0);
  std::vector<Eigen::Vector3f> kept;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (used[i] == 0) continue;
    index[i] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(mesh.vertices_trf_m[i]);
  }
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = index[first[corner]];
  }
  mesh.vertices_trf_m = std::move(kept);
}

bool has_area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Eigen::Vector3d a = mesh.vertices_trf_m[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices_trf_m[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices_trf_m[triangle[2]].cast<double>();
  const double longest_squared =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return 0.5 * (b - a).cross(c - a).norm() > kMinAreaShare * longest_squared;
}

std::string share_text(std::size_t part, std::size_t whole) {
  return std::to_string(part) + " of " + std::to_string(whole) + " triangles (" +
         number(100.0 * static_cast<double>(part) / static_cast<double>(whole)) + " %)";
}

void leave_out_triangles_without_area(const std::string& path, TriangleMesh& mesh) {
  const std::size_t all = mesh.triangles.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all; ++i) {
    if (!has_area(mesh, mesh.triangles[i])) continue;
    mesh.triangles[kept] = mesh.triangles[i];
    if (!mesh.is_panel.empty()) mesh.is_panel[kept] = mesh.is_panel[i];
    ++kept;
  }
  mesh.left_out = all - kept;
  if (kept == 0 || static_cast<double>(mesh.left_out) > kMaxShareWithoutArea * static_cast<double>(all)) {
    refuse(
        path,
        share_text(mesh.left_out, all) + " have no area, more than the " +
            number(100.0 * kMaxShareWithoutArea) +
            " % that are left out: details are lost, perhaps by a compression that rounds; remove degenerate "
            "faces in the modelling tool and export it again");
  }
  mesh.triangles.resize(kept);
  if (!mesh.is_panel.empty()) mesh.is_panel.resize(kept);
}

}  // namespace

TriangleMesh read_mesh_file(const std::string& path, const MeshFileOptions& options) {
  if (!std::isfinite(options.scale) || options.scale <= 0.0) {
    refuse(path, "the scale is " + number(options.scale) + ", it must be positive; correct --mesh-scale");
  }
  check_readable(path);
  check_format(path);
  TriangleMesh mesh;
  try {
    mesh = read_by_format(path, options);
  } catch (const InputRefused& error) {
    throw std::runtime_error(error.what());  // names the file
  } catch (const std::exception& error) {
    refuse(path, error.what());
  }
  mesh.name = path;
  if (mesh.triangles.empty()) {
    const std::string others = mesh.losses.empty() ? reading_note(mesh) : mesh.losses.front();
    refuse(path, "holds no triangles" + (others.empty() ? "" : " (" + others + ")") +
                     "; export the surface as a triangle mesh");
  }
  if (mesh.triangles.size() > kMaxTriangles) {
    refuse(path, "has " + std::to_string(mesh.triangles.size()) + " triangles, at most " +
                     std::to_string(kMaxTriangles) +
                     " are supported; simplify it in the modelling tool: 100000 show every detail that the "
                     "sensor can");
  }
  check_vertices(path, mesh.vertices_trf_m);
  check_extent(path, mesh.vertices_trf_m, options.scale);
  leave_out_triangles_without_area(path, mesh);
  join_equal_vertices(mesh);
  return mesh;
}

std::string fault_of_size(const TriangleMesh& mesh, double scale) {
  const double radius_m = mesh.radius_m();
  if (radius_m >= kMinMeshRadius_m && radius_m <= kMaxMeshRadius_m) return {};
  const bool is_large = radius_m > kMaxMeshRadius_m;
  const std::string limit = is_large ? "at most " + number(kMaxMeshRadius_m) + " m are supported: a target " +
                                           number(2.0 * kMaxMeshRadius_m) +
                                           " m across just fits the widest view of the sensor"
                                     : "at least " + number(kMinMeshRadius_m) + " m are needed";
  return "its farthest vertex is " + number(radius_m) + " m from the origin, " + limit +
         "; if the unit of the file is not the metre, give its length in metres with --mesh-scale (now " +
         number(scale) + ", 0.001 for millimetres, 0.0254 for inches)" +
         (is_large ? "; if its origin is off its centre or a part lies far away, `tumblesight mesh` shows "
                     "that and its --fix removes it"
                   : "");
}

TriangleMesh load_mesh_file(const std::string& path, const MeshFileOptions& options) {
  TriangleMesh mesh = read_mesh_file(path, options);
  const std::string fault = fault_of_size(mesh, options.scale);
  if (!fault.empty()) refuse(path, fault);
  return mesh;
}

std::string reading_note(const TriangleMesh& mesh) {
  std::string note;
  for (const std::string& text : mesh.notes) note += (note.empty() ? "" : "; ") + text;
  return note;
}

std::string left_out_note(const TriangleMesh& mesh) {
  std::string note;
  if (mesh.left_out > 0)
    note = share_text(mesh.left_out, mesh.triangles.size() + mesh.left_out) +
           (mesh.left_out == 1 ? " has" : " have") + " no area and " + (mesh.left_out == 1 ? "is" : "are") +
           " left out: no ray hits " + (mesh.left_out == 1 ? "it" : "them");
  for (const std::string& loss : mesh.losses) note += (note.empty() ? "" : "; ") + loss;
  const std::string others = reading_note(mesh);
  return note + (note.empty() || others.empty() ? "" : "; ") + others;
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
