#include "sim/inspection/marker_cube.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sim/inspection/cleaned_mesh.hpp"
#include "sim/surface/mesh_distance.hpp"
#include "sim/surface/outside_views.hpp"
#include "sim/world/target/panels.hpp"

namespace tumblesight::sim {
namespace {

using Triangles = std::vector<std::size_t>;

constexpr double kCubeTolerance = 1e-3;  // of its side
constexpr std::size_t kCubeTriangles = 12;
constexpr double kSameFace = 0.05;  // of its side: another surface so near stands in for the cube's

std::optional<MarkerCube> cube_about_origin(const TriangleMesh& mesh, const Triangles& part) {
  if (part.size() != kCubeTriangles) return std::nullopt;
  Eigen::AlignedBox3d box;
  double nearest_m = INFINITY, farthest_m = 0.0;
  for (const std::size_t triangle : part) {
    for (const std::uint32_t corner : mesh.triangles[triangle]) {
      const Eigen::Vector3d place = mesh.vertices_trf_m[corner].cast<double>();
      box.extend(place);
      nearest_m = std::min(nearest_m, place.norm());
      farthest_m = std::max(farthest_m, place.norm());
    }
  }
  const double side_m = box.sizes().maxCoeff();
  const bool is_cube = farthest_m - nearest_m < kCubeTolerance * side_m &&
                       side_m - box.sizes().minCoeff() < kCubeTolerance * side_m &&
                       box.center().norm() < kCubeTolerance * side_m;
  return is_cube ? std::optional<MarkerCube>({part, side_m}) : std::nullopt;
}

}  // namespace

std::optional<MarkerCube> marker_cube(const TriangleMesh& mesh) {
  const std::vector<Triangles> parts = connected_parts(mesh);
  std::optional<MarkerCube> largest;
  if (parts.size() < 2) return largest;
  for (const Triangles& part : parts) {
    const std::optional<MarkerCube> cube = cube_about_origin(mesh, part);
    if (cube && (!largest || cube->side_m > largest->side_m)) largest = cube;
  }
  return largest;
}

double outer_share_of(const TriangleMesh& mesh, const MarkerCube& cube) {
  TriangleMesh unit = mesh;  // the sensor model does not see far
  const double radius_m = mesh.radius_m();
  for (Eigen::Vector3f& vertex : unit.vertices_trf_m) vertex /= static_cast<float>(radius_m);
  const std::vector<Eigen::Vector3f> points = outer_surface(unit).points_trf_m;
  const TriangleMesh rest = without(unit, cube.triangles);
  const MeshDistance distance(rest);
  const auto lost = std::count_if(points.begin(), points.end(), [&](const Eigen::Vector3f& point) {
    return distance.distance_m(point) > kSameFace * cube.side_m / radius_m;
  });
  return points.empty() ? 1.0 : static_cast<double>(lost) / static_cast<double>(points.size());
}

}  // namespace tumblesight::sim
