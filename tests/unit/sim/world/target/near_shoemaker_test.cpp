#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/world/target/shipped_meshes.hpp"
#include "tests/unit/sim/world/target/mesh_measures.hpp"

namespace tumblesight::sim {
namespace {

constexpr float kPi = 3.14159265F;

Eigen::Vector3f heading(float angle_rad) {
  return {std::cos(angle_rad), std::sin(angle_rad), 0.0F};
}

TEST(NearShoemaker, FillsItsBoundingBox) {
  const Eigen::AlignedBox3f box = bounding_box(make_near_shoemaker());
  for (int axis = 0; axis < 3; ++axis) {
    const float half = axis == 2 ? 1.43F : 2.65F;
    EXPECT_NEAR(box.min()[axis], -half, 0.02F);
    EXPECT_NEAR(box.max()[axis], half, 0.02F);
  }
}

// The dish, measured along vertical lines between the tripod's legs.
TEST(NearShoemaker, DishHasItsProfile) {
  const TriangleMesh mesh = make_near_shoemaker();
  const Eigen::Vector3f clear = heading(4.0F * kPi / 3.0F);
  const float profile_rz[][2] = {
      {0.10F, 0.59F}, {0.28F, 0.60F}, {0.45F, 0.63F}, {0.56F, 0.66F}, {0.66F, 0.71F}};
  for (const auto& [r, z] : profile_rz) {
    EXPECT_NEAR(crossings_z_m(mesh, r * clear.x(), r * clear.y()).back(), z, 0.01F) << r;
  }
  const auto rim = [](const Eigen::Vector3f& v) { return v.z() > 0.75F && v.head<2>().norm() < 0.80F; };
  EXPECT_NEAR(reach_m(mesh, heading(0.0F), rim), 0.75F, 0.01F);
}

TEST(NearShoemaker, FourPanelsExtendAlongXAndY) {
  const TriangleMesh mesh = make_near_shoemaker();
  const auto outside_body = [](const Eigen::Vector3f& v) { return v.head<2>().norm() > 1.2F; };
  int panel_vertices = 0;
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m) {
    if (!outside_body(v)) {
      continue;
    }
    ++panel_vertices;
    const float along = std::max(std::abs(v.x()), std::abs(v.y()));
    const float across = std::min(std::abs(v.x()), std::abs(v.y()));
    EXPECT_NEAR(along, 2.647F, 0.01F);
    EXPECT_NEAR(across, 0.61F, 0.01F);
    EXPECT_NEAR(v.z(), 0.75F, 0.02F);
  }
  EXPECT_EQ(panel_vertices % 4, 0);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(reach_m(mesh, heading(static_cast<float>(i) * kPi / 2.0F), outside_body), 2.647F, 0.01F);
  }
}

TEST(NearShoemaker, BodyIsAnOctagonOf1Point5MetresAcrossFlats) {
  const TriangleMesh mesh = make_near_shoemaker();
  const auto on_body = [](const Eigen::Vector3f& v) {
    // without the decks and the thruster
    return (v.z() > -0.93F && v.z() < -0.5F) || (v.z() > 0.1F && v.z() < 0.48F);
  };
  for (const int side : {0, 2, 4, 6}) {
    EXPECT_NEAR(reach_m(mesh, heading(static_cast<float>(side) * kPi / 4.0F), on_body), 0.75F, 0.02F);
  }
}

// After a quarter turn the surface nearly coincides with itself: the mean distance is 8 mm, on a size of 5.3
// m.
TEST(NearShoemaker, IsNearlyButNotQuiteFourfoldSymmetric) {
  const TriangleMesh mesh = make_near_shoemaker();
  EXPECT_LT(moved_by_turn_m(mesh, 0.0F), 1e-5);
  for (int quarter = 1; quarter < 4; ++quarter) {
    const double moved = moved_by_turn_m(mesh, static_cast<float>(quarter) * kPi / 2.0F);
    EXPECT_GT(moved, 0.005) << quarter;
    EXPECT_LT(moved, 0.040) << quarter;
  }
  EXPECT_GT(moved_by_turn_m(mesh, kPi / 4.0F), 0.1);
}

TEST(NearShoemaker, ThrusterProtrudesBetweenXAndYOnly) {
  const TriangleMesh mesh = make_near_shoemaker();
  const auto at_thruster = [](const Eigen::Vector3f& v) { return std::abs(v.z() + 0.222F) < 0.2F; };
  EXPECT_NEAR(reach_m(mesh, heading(kPi / 4.0F), at_thruster), 1.0F, 0.02F);
  for (const int corner : {3, 5, 7}) {
    EXPECT_LT(reach_m(mesh, heading(static_cast<float>(corner) * kPi / 4.0F), at_thruster), 0.8F) << corner;
  }
}

TEST(NearShoemaker, AftDeckCarriesItsTallestInstrumentsInTwoOppositeCorners) {
  const TriangleMesh mesh = make_near_shoemaker();
  const auto tall_instrument = [](const Eigen::Vector3f& v) {
    return v.z() < -1.2F && v.head<2>().norm() > 0.5F;
  };
  EXPECT_NEAR(reach_m(mesh, heading(kPi / 4.0F), tall_instrument), 1.15F, 0.03F);
  EXPECT_NEAR(reach_m(mesh, heading(5.0F * kPi / 4.0F), tall_instrument), 0.87F, 0.03F);
  EXPECT_LT(reach_m(mesh, heading(3.0F * kPi / 4.0F), tall_instrument), 0.6F);
  EXPECT_LT(reach_m(mesh, heading(7.0F * kPi / 4.0F), tall_instrument), 0.6F);
}

}  // namespace
}  // namespace tumblesight::sim
