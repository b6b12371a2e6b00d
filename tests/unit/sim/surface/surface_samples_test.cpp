#include "sim/surface/surface_samples.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "gnc/surface/surface_model.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using gnc::SurfaceModel;

// Two plates of 2 m x 2 m, of which the lower one is seen from below only and the upper one from above.
TriangleMesh two_plates() {
  TriangleMesh mesh;
  mesh.name = "two plates";
  for (const float z : {-0.02F, 0.02F}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_trf_m.size());
    for (const auto& [x, y] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}})
      mesh.vertices_trf_m.emplace_back(x, y, z);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

const double kTargetRadius_m = two_plates().radius_m();
const std::vector<std::uint8_t>& section_of_plates() {
  static const std::vector<std::uint8_t> section = surface_section(two_plates(), kTargetRadius_m);
  return section;
}

Vector3d position_m(const SurfaceModel& surface, int index, double radius_m) {
  const auto [x, y, z] = surface.point(index).position;
  return radius_m / SurfaceModel::kRadius * Vector3d(x, y, z);
}
Vector3d normal(const SurfaceModel& surface, int index) {
  const auto [x, y, z] = surface.point(index).normal;
  return Vector3d(x, y, z) / SurfaceModel::kUnitNormal;
}

TEST(SurfaceSamples, LieOnTheSurfaceAndFaceOutwards) {
  const SurfaceModel surface(section_of_plates().data());
  EXPECT_LE(surface.points(), 2048U);
  EXPECT_GT(surface.points(), 1900U);
  int up = 0;
  for (int i = 0; i < static_cast<int>(surface.points()); ++i) {
    const Vector3d at = position_m(surface, i, kTargetRadius_m);
    ASSERT_NEAR(std::abs(at.z()), 0.02, 1e-4) << i;
    ASSERT_LE(at.head<2>().cwiseAbs().maxCoeff(), 1.0 + 1e-4) << i;
    up += at.z() > 0.0 ? 1 : 0;
    // Near the rim the inner sides are seen through the gap.
    if (at.head<2>().cwiseAbs().maxCoeff() > 0.9) continue;
    ASSERT_NEAR(normal(surface, i).z(), at.z() > 0.0 ? 1.0 : -1.0, 1e-6) << i << ": inside nothing is seen";
  }
  EXPECT_NEAR(up, surface.points() / 2.0, 0.03 * surface.points());
}

TEST(SurfaceSamples, AreSpreadEvenly) {
  const SurfaceModel surface(section_of_plates().data());
  const double spacing_m = 1e-3 * surface.spacing_mm();
  // 1024 points on 4 m^2, each in the middle of an empty circle.
  EXPECT_NEAR(spacing_m, std::sqrt(4.0 / 1024.0), 0.4 * std::sqrt(4.0 / 1024.0));
  for (double x = -0.95; x < 1.0; x += 0.19) {
    for (double y = -0.95; y < 1.0; y += 0.19) {
      double nearest_m = std::numeric_limits<double>::infinity();
      for (int i = 0; i < static_cast<int>(surface.points()); ++i)
        nearest_m =
            std::min(nearest_m, (position_m(surface, i, kTargetRadius_m) - Vector3d(x, y, 0.02)).norm());
      EXPECT_LT(nearest_m, 1.1 * spacing_m) << x << ' ' << y;
    }
  }
}

TEST(SurfaceSamples, AreTheSameEveryTime) {
  EXPECT_EQ(surface_section(two_plates(), kTargetRadius_m), section_of_plates());
}

TEST(SurfaceSamples, NeedASurface) {
  EXPECT_THROW((void)surface_section(TriangleMesh{}, 1.0), std::invalid_argument);
}

TEST(SurfaceSamples, AreUnlikeThoseOfATurnedMeshOnly) {
  const SurfaceModel plates(section_of_plates().data());
  TriangleMesh standing = two_plates();
  for (Eigen::Vector3f& v : standing.vertices_trf_m) v = {v.x(), -v.z(), v.y()};
  const std::vector<std::uint8_t> section = surface_section(standing, kTargetRadius_m);
  const SurfaceModel turned(section.data());
  EXPECT_EQ(unlike_share(plates, plates), 0.0);
  EXPECT_GT(unlike_share(plates, turned), 0.7);
  const Eigen::Matrix3d back = Eigen::AngleAxisd(-0.5 * kPi, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(unlike_share(plates, turned, back), 0.0);
  EXPECT_EQ(unlike_share(plates, SurfaceModel()), 0.0) << "nothing to compare with";
}

}  // namespace
}  // namespace tumblesight::sim
