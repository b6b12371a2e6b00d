#include "sim/surface/outside_views.hpp"

#include <cmath>

#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;

constexpr int kViewRays = 256;  // per side
constexpr double kGoldenAngle_rad = 2.399963229728653;
// A prime, so that the rays that give a point are spread over a view's rows and columns.
constexpr std::size_t kRaysPerPoint = 31;

Vector3d direction_lrf(const RangeGrid& grid, std::size_t ray) {
  const int row = static_cast<int>(ray) / grid.rays, column = static_cast<int>(ray) % grid.rays;
  return Vector3d(grid.slope(column), 1.0, -grid.slope(row)).normalized();
}

Vector3d point_trf_m(const RangeGrid& grid, std::size_t ray, const FrameTruth& truth) {
  const Vector3d target_lrf_m(0.0, truth.range_m, 0.0);
  return truth.q_lrf_trf.conjugate() * (grid.range_m[ray] * direction_lrf(grid, ray) - target_lrf_m);
}

std::vector<Vector3d> normals_trf(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d first = mesh.vertices_trf_m[a].cast<double>();
    const Vector3d to_second = mesh.vertices_trf_m[b].cast<double>() - first;
    normals.emplace_back(to_second.cross(mesh.vertices_trf_m[c].cast<double>() - first));
  }
  return normals;
}

}  // namespace

FrameTruth outside_view(const TriangleMesh& mesh, int index) {
  const double z = 1.0 - (2.0 * index + 1.0) / kOutsideViews, across = std::sqrt(1.0 - z * z);
  const Vector3d to_sensor(across * std::cos(kGoldenAngle_rad * index),
                           across * std::sin(kGoldenAngle_rad * index), z);
  const auto q_lrf_trf = Eigen::Quaterniond::FromTwoVectors(to_sensor, -Vector3d::UnitY());
  const double radius_m = mesh.radius_m();
  return {q_lrf_trf, Vector3d::Zero(), kOutsideDistance_radii * radius_m};
}

OuterSurface outer_surface(const TriangleMesh& mesh) {
  const FlashLidar lidar(mesh);
  const std::vector<Vector3d> normals = normals_trf(mesh);
  OuterSurface outer;
  outer.is_seen.resize(mesh.triangles.size(), 0);
  outer.hits.resize(mesh.triangles.size(), {0, 0});
  for (int i = 0; i < kOutsideViews; ++i) {
    const FrameTruth truth = outside_view(mesh, i);
    const RangeGrid grid = lidar.true_surfaces(truth, kViewRays, swath_m(mesh));
    const Eigen::Matrix3d r_lrf_trf = truth.q_lrf_trf.toRotationMatrix();
    for (std::size_t ray = 0; ray < grid.range_m.size(); ++ray) {
      if (!std::isfinite(grid.range_m[ray])) continue;
      const std::uint32_t triangle = grid.surfaces[ray].triangle;
      outer.is_seen[triangle] = 1;
      const bool is_back = (r_lrf_trf * normals[triangle]).dot(direction_lrf(grid, ray)) > 0.0;
      ++outer.hits[triangle][is_back ? 1 : 0];
      if (ray % kRaysPerPoint == 0) outer.points_trf_m.push_back(point_trf_m(grid, ray, truth).cast<float>());
    }
  }
  return outer;
}

}  // namespace tumblesight::sim
