// TriangleMesh: a target's surface in its own frame.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

struct TriangleMesh {
  std::string name;  // for messages: the target, or the file
  std::vector<Eigen::Vector3f> vertices_trf_m;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // vertex indices; both sides reflect
  // Per triangle: 1 if it belongs to a solar panel. Empty: not known, see panels.hpp.
  std::vector<std::uint8_t> is_panel{};
  // Triangles of the file that are not among these, because they have no area.
  std::size_t left_out = 0;
  // What else of the file is not among them, a phrase each. `losses` are those by which surface is missing.
  std::vector<std::string> notes{};
  std::vector<std::string> losses{};

  // A triangle's corners.
  std::array<Eigen::Vector3d, 3> corners_trf_m(std::size_t triangle) const {
    const auto& [a, b, c] = triangles[triangle];
    return {vertices_trf_m[a].cast<double>(), vertices_trf_m[b].cast<double>(),
            vertices_trf_m[c].cast<double>()};
  }
  // Largest distance of a vertex from the TRF's origin.
  float radius_m() const {
    float radius = 0.0F;
    for (const Eigen::Vector3f& vertex : vertices_trf_m) radius = std::max(radius, vertex.norm());
    return radius;
  }
};

}  // namespace tumblesight::sim
