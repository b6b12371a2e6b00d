#include "sim/surface/surface_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sim/surface/mesh_distance.hpp"
#include "sim/world/target/primitives.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3f;

constexpr float kRadius_m = 1.5F;

// Evenly spread over a sphere.
std::vector<Vector3f> points_of_sphere(int count) {
  std::vector<Vector3f> points_m;
  for (int i = 0; i < count; ++i) {
    const float z = 1.0F - (2.0F * static_cast<float>(i) + 1.0F) / static_cast<float>(count);
    const float across = std::sqrt(1.0F - z * z), angle_rad = 2.3999632F * static_cast<float>(i);
    points_m.push_back(kRadius_m * Vector3f(across * std::cos(angle_rad), across * std::sin(angle_rad), z));
  }
  return points_m;
}

// A sphere of few triangles, whose vertices lie on the true one: all else of it lies inside.
TriangleMesh coarse_sphere() {
  constexpr int kSides = 12;
  Outline profile;
  for (int i = 0; i <= kSides / 2; ++i) {
    const float angle_rad = 2.0F * static_cast<float>(M_PI) * static_cast<float>(i) / kSides;
    const bool is_pole = i == 0 || i == kSides / 2;
    profile.emplace_back(is_pole ? 0.0F : kRadius_m * std::sin(angle_rad), kRadius_m * std::cos(angle_rad));
  }
  TriangleMesh mesh = revolve(profile, kSides);
  mesh.name = "coarse sphere";
  return mesh;
}

// Mean of how far the points lie outside the mesh, which is convex around the origin.
double mean_outside_m(const std::vector<Vector3f>& points_m, const TriangleMesh& mesh) {
  const MeshDistance distance(mesh);
  double sum_m = 0.0;
  for (const Vector3f& point_m : points_m) {
    const ClosestPoint closest = distance.closest(point_m);
    const bool is_outside = point_m.norm() > closest.point_m.norm();
    sum_m += (is_outside ? 1.0 : -1.0) * static_cast<double>(closest.distance_m);
  }
  return sum_m / static_cast<double>(points_m.size());
}

double root_mean_square_m(const std::vector<Vector3f>& points_m, const TriangleMesh& mesh) {
  const MeshDistance distance(mesh);
  double sum = 0.0;
  for (const Vector3f& point_m : points_m)
    sum += std::pow(static_cast<double>(distance.distance_m(point_m)), 2);
  return std::sqrt(sum / static_cast<double>(points_m.size()));
}

TEST(SurfaceFit, TakesTheShrinkageOfASphereAway) {
  const std::vector<Vector3f> points_m = points_of_sphere(20'000);
  const TriangleMesh before = coarse_sphere(), after = fitted(before, points_m, 0.5);
  EXPECT_GT(mean_outside_m(points_m, before), 0.03);
  EXPECT_LT(std::abs(mean_outside_m(points_m, after)), 0.001);
  EXPECT_LT(root_mean_square_m(points_m, after), 0.5 * root_mean_square_m(points_m, before));
  EXPECT_EQ(after.triangles, before.triangles);
}

TEST(SurfaceFit, LeavesAnExactMeshWhereItIs) {
  TriangleMesh mesh = box({2.0F, 1.2F, 0.8F});
  mesh.name = "block";
  std::vector<Vector3f> points_m;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3f &first = mesh.vertices_trf_m[a], &second = mesh.vertices_trf_m[b],
                   &third = mesh.vertices_trf_m[c];
    for (int i = 0; i <= 20; ++i)
      for (int k = 0; i + k <= 20; ++k)
        points_m.push_back(first + (0.05F * static_cast<float>(i)) * (second - first) +
                           (0.05F * static_cast<float>(k)) * (third - first));
  }
  const TriangleMesh after = fitted(mesh, points_m, 0.1);
  for (std::size_t i = 0; i < mesh.vertices_trf_m.size(); ++i)
    EXPECT_LT((after.vertices_trf_m[i] - mesh.vertices_trf_m[i]).norm(), 1e-5F) << i;
}

TEST(SurfaceFit, PointsBeyondReachDoNotPull) {
  TriangleMesh mesh = box({2.0F, 1.2F, 0.8F});
  mesh.name = "block";
  const std::vector<Vector3f> lost_strut_m(100, Vector3f(0.0F, 0.0F, 3.0F));
  EXPECT_EQ(fitted(mesh, lost_strut_m, 0.5).vertices_trf_m, mesh.vertices_trf_m);
  EXPECT_NE(fitted(mesh, lost_strut_m, 5.0).vertices_trf_m, mesh.vertices_trf_m);
}

// Neither points nor triangles, and a vertex that belongs to no triangle.
TEST(SurfaceFit, WithoutAnythingToFitNothingMoves) {
  TriangleMesh mesh = box({2.0F, 1.2F, 0.8F});
  mesh.name = "block";
  mesh.vertices_trf_m.emplace_back(9.0F, 9.0F, 9.0F);
  EXPECT_EQ(fitted(mesh, {}, 0.5).vertices_trf_m, mesh.vertices_trf_m);
  EXPECT_EQ(fitted(mesh, {Vector3f(1.05F, 0.0F, 0.0F)}, 0.5).vertices_trf_m.back(),
            mesh.vertices_trf_m.back());
  mesh.triangles.clear();
  EXPECT_EQ(fitted(mesh, {Vector3f::Zero()}, 0.5).vertices_trf_m, mesh.vertices_trf_m);
}

}  // namespace
}  // namespace tumblesight::sim
