#include "sim/world/target/mesh_builder.hpp"

#include <cctype>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "sim/world/target/mesh_axes.hpp"

namespace tumblesight::sim {
namespace {

std::string text_of(const Eigen::Vector3d& place) {
  char text[96];
  std::snprintf(text, sizeof(text), "(%.4g, %.4g, %.4g)", place.x(), place.y(), place.z());
  return text;
}

void check_count(std::size_t count, std::size_t most, const char* what) {
  if (count <= most) return;
  throw std::runtime_error("has at least " + std::to_string(count) + " " + what + ", at most " +
                           std::to_string(most) +
                           " are supported; simplify it in the modelling tool: 100000 triangles show every "
                           "detail that the sensor can");
}

}  // namespace

bool names_a_panel(std::string material) {
  for (char& c : material) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return material.find("panel") != std::string::npos || material.find("solar") != std::string::npos;
}

MeshBuilder::MeshBuilder(const MeshFileOptions& options, const char* unit)
    : to_trf_m_(options.scale * axes_trf_file(options.up)),
      origin_trf_m_(options.origin_trf_m),
      unit_(unit) {}

std::uint32_t MeshBuilder::add_vertex(const Eigen::Vector3d& place, std::size_t number) {
  const Eigen::Vector3f vertex = (to_trf_m_ * place - origin_trf_m_).cast<float>();
  if (!vertex.allFinite() && not_finite_++ == 0) {
    first_number_ = number;
    first_place_ = place;
  }
  mesh_.vertices_trf_m.push_back(vertex);
  return static_cast<std::uint32_t>(mesh_.vertices_trf_m.size() - 1);
}

void MeshBuilder::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, bool is_panel) {
  mesh_.triangles.push_back({a, b, c});
  mesh_.is_panel.push_back(is_panel ? 1 : 0);
  any_panel_ = any_panel_ || is_panel;
  check_triangle_count(mesh_.triangles.size());
}

TriangleMesh MeshBuilder::finish() {
  if (not_finite_ > 0)
    throw std::runtime_error(
        std::to_string(not_finite_) + " of " + std::to_string(mesh_.vertices_trf_m.size()) +
        " corners are not finite, the first in " + unit_ + " " + std::to_string(first_number_) + ", " +
        text_of(first_place_) + "; repair the mesh and export it again");
  if (!any_panel_) mesh_.is_panel.clear();
  return std::move(mesh_);
}

void check_triangle_count(std::size_t triangles) {
  check_count(triangles, kMaxTriangles, "triangles");
}

void check_vertex_count(std::size_t vertices) {
  check_count(vertices, 3 * kMaxTriangles, "vertices");
}

}  // namespace tumblesight::sim
