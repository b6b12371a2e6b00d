#include "sim/inspection/convex_part.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using Triangles = std::vector<std::size_t>;

constexpr std::size_t kTetrahedron = 4;
constexpr std::size_t kMostTriangles = 20'000;

std::vector<Vector3d> corners_of(const TriangleMesh& mesh, const Triangles& part) {
  std::vector<std::uint32_t> numbers;
  for (const std::size_t triangle : part)
    numbers.insert(numbers.end(), mesh.triangles[triangle].begin(), mesh.triangles[triangle].end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<Vector3d> corners;
  corners.reserve(numbers.size());
  for (const std::uint32_t number : numbers) corners.emplace_back(mesh.vertices_trf_m[number].cast<double>());
  return corners;
}

// Every edge belongs to two triangles, by the places of its ends.
bool is_closed(const TriangleMesh& mesh, const Triangles& part) {
  using Place = std::array<float, 3>;
  std::map<std::pair<Place, Place>, int> edges;
  const auto place = [&](std::size_t triangle, std::size_t which) {
    const Eigen::Vector3f& v = mesh.vertices_trf_m[mesh.triangles[triangle][which]];
    return Place{v.x(), v.y(), v.z()};
  };
  for (const std::size_t triangle : part) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Place a = place(triangle, i), b = place(triangle, (i + 1) % 3);
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  }
  return std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second % 2 == 0; });
}

}  // namespace

// The planes of its triangles; none if the part is not convex.
std::vector<ConvexPart::Plane> ConvexPart::planes_if_convex(const TriangleMesh& mesh, const Triangles& part,
                                                            double tolerance_m) {
  const std::vector<Vector3d> corners = corners_of(mesh, part);
  Eigen::AlignedBox3d box;
  for (const Vector3d& place : corners) box.extend(place);
  std::vector<Plane> planes;
  for (const std::size_t triangle : part) {
    const auto [a, b, c] = mesh.corners_trf_m(triangle);
    const Vector3d across = (b - a).cross(c - a);
    if (!(across.norm() > 0.0)) continue;
    Plane plane{across.normalized(), 0.0};
    plane.offset_m = plane.normal.dot(a);
    if (plane.outside_by_m(box.center()) > 0.0) plane = {-plane.normal, -plane.offset_m};
    const bool has_dent = std::any_of(corners.begin(), corners.end(), [&](const Vector3d& place) {
      return plane.outside_by_m(place) > tolerance_m;
    });
    if (has_dent) return {};
    planes.push_back(plane);
  }
  return planes;
}

std::optional<ConvexPart> ConvexPart::of(const TriangleMesh& mesh, const Triangles& part,
                                         double tolerance_m) {
  if (part.size() < kTetrahedron || part.size() > kMostTriangles) return std::nullopt;
  ConvexPart convex;
  convex.tolerance_m_ = tolerance_m;
  convex.planes_ = planes_if_convex(mesh, part, tolerance_m);
  if (convex.planes_.size() < kTetrahedron || !is_closed(mesh, part)) return std::nullopt;
  return convex;
}

bool ConvexPart::holds(const Vector3d& point_trf_m) const {
  return std::all_of(planes_.begin(), planes_.end(),
                     [&](const Plane& plane) { return plane.outside_by_m(point_trf_m) < -tolerance_m_; });
}

}  // namespace tumblesight::sim
