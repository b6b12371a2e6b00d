#include "sim/inspection/write_mesh.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "sim/host/write_file.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kStlTitleBytes = 80;

void append_u32(std::string& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
}

void append_vector(std::string& bytes, const Eigen::Vector3f& v) {
  for (const float value : {v.x(), v.y(), v.z()}) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    append_u32(bytes, bits);
  }
}

std::string stl_of(const TriangleMesh& mesh) {
  std::string bytes = "binary STL in metres, z up";
  bytes.resize(kStlTitleBytes, ' ');
  append_u32(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& v = mesh.vertices_trf_m;
    append_vector(bytes, (v[b] - v[a]).cross(v[c] - v[a]).normalized());
    for (const std::uint32_t corner : {a, b, c}) append_vector(bytes, v[corner]);
    bytes.append(2, '\0');
  }
  return bytes;
}

constexpr std::array<const char*, 2> kMaterials{"body", "solar_panel"};

std::string obj_of(const TriangleMesh& mesh, const std::string& materials) {
  std::string text = "# in metres, z up\n";
  if (!mesh.is_panel.empty()) text += "mtllib " + materials + "\n";
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m)
    text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  int material = -1;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!mesh.is_panel.empty() && material != mesh.is_panel[i]) {
      material = mesh.is_panel[i];
      text += fmt::format("usemtl {}\n", kMaterials[mesh.is_panel[i] != 0 ? 1 : 0]);
    }
    const auto& t = mesh.triangles[i];
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

std::string materials_of(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".mtl").string();
}

void write_mesh(const std::string& path, const TriangleMesh& mesh) {
  const std::string ending = ending_of(path);
  if (ending == ".stl") {
    write_file(path, stl_of(mesh));
    return;
  }
  if (ending != ".obj") throw std::invalid_argument("'" + path + "' must end in .stl or .obj");
  const std::string materials = materials_of(path);
  if (!mesh.is_panel.empty())
    write_file(materials, fmt::format("newmtl {}\nnewmtl {}\n", kMaterials[0], kMaterials[1]));
  write_file(path, obj_of(mesh, std::filesystem::path(materials).filename().string()));
}

}  // namespace tumblesight::sim
