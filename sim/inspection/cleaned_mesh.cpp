#include "sim/inspection/cleaned_mesh.hpp"

#include <cstdint>

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kNone = ~0U;

void append(const TriangleMesh& from, std::size_t triangle, std::vector<std::uint32_t>& index,
            TriangleMesh& to) {
  std::array<std::uint32_t, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint32_t& number = index[from.triangles[triangle][i]];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(to.vertices_trf_m.size());
      to.vertices_trf_m.push_back(from.vertices_trf_m[from.triangles[triangle][i]]);
    }
    corners[i] = number;
  }
  to.triangles.push_back(corners);
  if (!from.is_panel.empty()) to.is_panel.push_back(from.is_panel[triangle]);
}

}  // namespace

TriangleMesh without(const TriangleMesh& mesh, const std::vector<std::size_t>& left_out) {
  if (left_out.empty()) return mesh;
  std::vector<std::uint8_t> is_left_out(mesh.triangles.size(), 0);
  for (const std::size_t triangle : left_out) is_left_out[triangle] = 1;
  TriangleMesh rest;
  rest.name = mesh.name;
  rest.left_out = mesh.left_out;
  std::vector<std::uint32_t> index(mesh.vertices_trf_m.size(), kNone);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (is_left_out[i] == 0) append(mesh, i, index, rest);
  }
  return rest;
}

std::vector<std::size_t> triangles_of_strays(const MeshInspection& found) {
  std::vector<std::size_t> triangles;
  for (const std::size_t stray : found.strays) {
    const std::vector<std::size_t>& of_part = found.parts[stray].triangles;
    triangles.insert(triangles.end(), of_part.begin(), of_part.end());
  }
  return triangles;
}

CleanedMesh cleaned(const TriangleMesh& mesh, const MeshInspection& found, const CleaningOptions& options) {
  CleanedMesh result;
  std::vector<std::size_t> left_out;
  if (!options.keep_strays) left_out = triangles_of_strays(found);
  result.strays = left_out.size();
  if (found.marker_can_go()) {
    left_out.insert(left_out.end(), found.marker->triangles.begin(), found.marker->triangles.end());
    result.marker = found.marker->triangles.size();
  }
  const std::vector<std::uint8_t> repeated = repeated_triangles(mesh);
  for (std::size_t i = 0; i < repeated.size(); ++i) {
    if (repeated[i] == 0) continue;
    left_out.push_back(i);
    ++result.repeated;
  }
  result.mesh = without(mesh, left_out);
  result.moved_m = -options.origin_trf_m.value_or(found.symmetry.centre_trf_m);
  for (Eigen::Vector3f& vertex : result.mesh.vertices_trf_m)
    vertex = (vertex.cast<double>() + result.moved_m).cast<float>();
  return result;
}

}  // namespace tumblesight::sim
