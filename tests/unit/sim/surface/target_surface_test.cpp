#include "sim/surface/target_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sim/surface/mesh_distance.hpp"
#include "sim/surface/surface_mesh.hpp"
#include "sim/surface/surface_samples.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3f;
using gnc::SurfaceMesh;

TEST(TargetSurface, OfAMeshWithoutASurfaceIsRefusedWithTheRemedy) {
  TriangleMesh none;
  none.name = "none.stl";
  for (const double radius_m : {1.0, 0.0}) {
    try {
      (void)target_surface(none, radius_m);
      FAIL() << radius_m;
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find("the surface of mesh none.stl cannot be put into a model image: "), 0U) << text;
      EXPECT_NE(text.find("; give a mesh of the target's outer surface, in metres (--mesh, --mesh-scale)"),
                std::string::npos)
          << text;
    }
  }
}

TEST(TargetSurface, IsDescribedByItsNumbers) {
  SurfaceSections surface;
  surface.points.resize(gnc::SurfaceModel::kBytes);
  surface.points[1] = 4;   // 1024 points
  surface.points[4] = 90;  // mm
  surface.mesh = {200, 0, 44, 1, 33, 1, 27, 0};
  surface.mesh.resize(SurfaceMesh::kMaxBytes);
  EXPECT_EQ(description(surface),
            "1024 points of the surface, 90 mm apart; 300 triangles, 289 edges, at most 27 mm from the mesh");
}

#ifdef TUMBLESIGHT_HAS_MESHOPTIMIZER
TEST(TargetSurface, HasPointsAndTrianglesOfOneMesh) {
  TriangleMesh block = box({1.0F, 2.0F, 3.0F});
  block.name = "block";
  const SurfaceSections surface = target_surface(block, 2.0);
  EXPECT_EQ(surface.points, surface_section(block, 2.0));
  EXPECT_EQ(surface.mesh, surface_mesh_section(block, 2.0));
  EXPECT_EQ(SurfaceMesh(surface.mesh.data()).triangles(), 12);
}
#endif

// The images that fly state how far their surface is from the parametric mesh: at the corners and along the
// edges of both it is true.
class ShippedSurface : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedSurface, IsThatOfTheParametricMeshWithinItsError) {
  const std::string path = TUMBLESIGHT_SOURCE_DIR "/fsw/models/" + GetParam() + ".tsm";
  const gnc::ModelHeader header = read_fixed_point_header(path);
  const std::vector<std::uint8_t> image = read_model_bytes(path);
  EXPECT_EQ(gnc::surface_of<gnc::FixedPoint>(image.data()).points(), 2048U);
  const SurfaceMesh section = gnc::surface_mesh_of<gnc::FixedPoint>(image.data());
  EXPECT_GT(section.triangles(), 2000);
  EXPECT_GT(section.edges(), 2000);
  EXPECT_LT(section.triangles(), 3100);
  // A strut of the Aquarius that is thinner than the rays are apart is left out.
  EXPECT_LE(section.error_mm(), 200);
  const auto unit_m = static_cast<float>(1e-3 * header.projection.target_radius_mm / SurfaceMesh::kRadius);
  TriangleMesh surface;
  for (int i = 0; i < section.vertices(); ++i) {
    const auto [x, y, z] = section.vertex(i);
    surface.vertices_trf_m.emplace_back(unit_m * Vector3f(x, y, z));
  }
  std::vector<Vector3f> points_m = surface.vertices_trf_m;
  for (int i = 0; i < section.triangles(); ++i) {
    const auto [a, b, c] = section.triangle(i);
    surface.triangles.push_back({a, b, c});
    points_m.emplace_back((surface.vertices_trf_m[a] + surface.vertices_trf_m[b]) / 2.0F);
  }
  const float error_m = 1e-3F * static_cast<float>(section.error_mm()) + 1e-4F;
  const TriangleMesh mesh = target_by_name(GetParam());
  EXPECT_LT(MeshDistance(mesh).largest_distance_m(points_m), error_m);
  // The surface also has all of the mesh that the points of the check show.
  const gnc::SurfaceModel points = gnc::surface_of<gnc::FixedPoint>(image.data());
  std::vector<Vector3f> seen_m;
  for (int i = 0; i < 2048; ++i) {
    const auto [x, y, z] = points.point(i).position;
    seen_m.emplace_back(unit_m * Vector3f(x, y, z));
  }
  const MeshDistance distance(surface);
  EXPECT_LT(distance.largest_distance_m(seen_m), error_m);
  double sum_m = 0.0;
  for (const Vector3f& point_m : seen_m) sum_m += static_cast<double>(distance.distance_m(point_m));
  const double radius_m = 1e-3 * header.projection.target_radius_mm;
  EXPECT_LT(sum_m / static_cast<double>(seen_m.size()), radius_m / 1500.0);
}

INSTANTIATE_TEST_SUITE_P(Targets, ShippedSurface,
                         ::testing::Values("near_shoemaker", "magellan", "sacd_aquarius",
                                           "sacd_aquarius_stowed"),
                         [](const auto& target) { return target.param; });

}  // namespace
}  // namespace tumblesight::sim
