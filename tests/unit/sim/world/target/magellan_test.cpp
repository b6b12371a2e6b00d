#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/target/shipped_meshes.hpp"
#include "tests/unit/sim/world/target/mesh_measures.hpp"

namespace tumblesight::sim {
namespace {

constexpr float kPi = 3.14159265F;
const Eigen::Vector3f kX = Eigen::Vector3f::UnitX();
const Eigen::Vector3f kY = Eigen::Vector3f::UnitY();
const Eigen::Vector3f kZ = Eigen::Vector3f::UnitZ();

bool within(float value, float from, float to) {
  return value > from && value < to;
}

TEST(Magellan, FillsItsBoundingBox) {
  const Eigen::AlignedBox3f box = bounding_box(make_magellan());
  EXPECT_LT((box.min() - Eigen::Vector3f(-4.45F, -1.85F, -1.71F)).cwiseAbs().maxCoeff(), 0.02F);
  EXPECT_LT((box.max() - Eigen::Vector3f(4.45F, 1.85F, 2.82F)).cwiseAbs().maxCoeff(), 0.02F);
}

// The figures are of the back of the dish, except the second one, which is of its front. Its wall is 3 cm
// thick along z.
TEST(Magellan, DishHasItsProfileAndRim) {
  const TriangleMesh mesh = make_magellan();
  const float profile_rz[][2] = {{0.89F, 1.38F}, {1.03F, 1.46F}, {1.30F, 1.56F},
                                 {1.44F, 1.65F}, {1.58F, 1.73F}, {1.71F, 1.82F}};
  for (const float heading : {0.5F, 2.6F, 4.5F}) {  // clear of the subreflector's legs
    for (const auto& [r, z] : profile_rz) {
      EXPECT_NEAR(crossings_z_m(mesh, r * std::cos(heading), r * std::sin(heading)).back(), z + 0.015F, 0.02F)
          << r;
    }
  }
  const auto rim = [](const Eigen::Vector3f& v) {
    return within(v.z(), 1.90F, 1.93F) && std::abs(v.x()) < 1.85F;
  };
  EXPECT_NEAR(reach_m(mesh, kX, rim), 1.85F, 0.02F);
  EXPECT_NEAR(reach_m(mesh, kY, rim), 1.85F, 0.02F);
  EXPECT_NEAR(reach_m(mesh, kZ, rim), 1.92F, 0.01F);
}

TEST(Magellan, SubreflectorHangsAboveTheDish) {
  const TriangleMesh mesh = make_magellan();
  EXPECT_NEAR(crossings_z_m(mesh, 0.20F, 0.05F).back(), 2.51F, 0.01F);
  const auto subreflector = [](const Eigen::Vector3f& v) { return v.z() > 2.45F; };
  for (const Eigen::Vector3f& axis : {kX, Eigen::Vector3f(-kX), kY, Eigen::Vector3f(-kY)}) {
    EXPECT_NEAR(reach_m(mesh, axis, subreflector), 0.30F, 0.025F);
  }
}

// Both panels lie in one plane at 45 deg between y and z, so they distinguish +y from -y.
TEST(Magellan, PanelsLieInOnePlaneTiltedBy45Degrees) {
  const TriangleMesh mesh = make_magellan();
  const auto panel = [](const Eigen::Vector3f& v) { return std::abs(v.x()) > 2.30F; };
  const Eigen::Vector3f centre(0.0F, 0.03F, -0.52F);
  const Eigen::Vector3f up = (kY + kZ).normalized();
  const Eigen::Vector3f normal = (kZ - kY).normalized();
  EXPECT_NEAR(reach_m(mesh, up, panel) - up.dot(centre), 2.73F / 2.0F, 0.02F);
  EXPECT_NEAR(reach_m(mesh, -up, panel) + up.dot(centre), 2.73F / 2.0F, 0.02F);
  EXPECT_NEAR(reach_m(mesh, normal, panel) - normal.dot(centre), 0.03F, 0.04F);
  EXPECT_NEAR(reach_m(mesh, -normal, panel) + normal.dot(centre), 0.03F, 0.04F);
  for (const Eigen::Vector3f& side : {kX, Eigen::Vector3f(-kX)}) {
    EXPECT_NEAR(reach_m(mesh, side, panel), 4.45F, 0.01F);
    // The inner edge: no vertex of the panel lies nearer to the bus.
    const auto near_edge = [&](const Eigen::Vector3f& v) {
      return side.dot(v) > 2.05F && std::abs(up.dot(v - centre)) > 0.5F;
    };
    EXPECT_NEAR(-reach_m(mesh, -side, near_edge), 2.17F, 0.01F);
  }
}

TEST(Magellan, BodyStandsOnItsBusAndAdapter) {
  const TriangleMesh mesh = make_magellan();
  const auto between = [](float from, float to) {
    return [from, to](const Eigen::Vector3f& v) {
      return within(v.z(), from, to) && v.head<2>().norm() < 0.96F;
    };
  };
  EXPECT_NEAR(reach_m(mesh, kY, between(-1.08F, -0.62F)), 0.93F, 0.02F);
  EXPECT_NEAR(reach_m(mesh, kX, between(-1.71F, -1.68F)), 0.85F, 0.02F);
  const auto forward_box = [](const Eigen::Vector3f& v) {
    return within(v.z(), -0.60F, -0.588F) && std::abs(v.y()) < 0.70F;
  };
  EXPECT_NEAR(reach_m(mesh, kY, forward_box), 1.30F / 2.0F, 0.01F);
  const auto pods = [](const Eigen::Vector3f& v) { return within(v.z(), -1.40F, -1.20F); };
  for (const float corner : {0.25F, 0.75F, 1.25F, 1.75F}) {
    EXPECT_NEAR(reach_m(mesh, {std::cos(corner * kPi), std::sin(corner * kPi), 0.0F}, pods), 2.18F, 0.02F)
        << corner;
  }
}

// Only the equipment and the tilt of the panels prevent a half turn about z from being a symmetry.
TEST(Magellan, HalfATurnIsItsOnlyNearSymmetryAboutZ) {
  const TriangleMesh mesh = make_magellan();
  EXPECT_LT(moved_by_turn_m(mesh, 0.0F), 1e-5);
  const double half = moved_by_turn_m(mesh, kPi);
  EXPECT_GT(half, 0.05);
  EXPECT_LT(half, 0.25);
  EXPECT_GT(moved_by_turn_m(mesh, kPi / 2.0F), 2.0 * half);
}

TEST(Magellan, AltimeterHornStandsOnMinusXOnly) {
  const TriangleMesh mesh = make_magellan();
  const auto mouth = [](const Eigen::Vector3f& v) {
    return within(v.z(), 1.75F, 1.88F) && std::abs(v.y()) < 0.32F && std::abs(v.x()) > 1.72F;
  };
  EXPECT_NEAR(reach_m(mesh, -kX, mouth), 2.18F, 0.01F);
  EXPECT_NEAR(reach_m(mesh, kY, mouth), 0.31F, 0.01F);
  EXPECT_NEAR(reach_m(mesh, -kY, mouth), 0.31F, 0.01F);
  EXPECT_LT(reach_m(mesh, kX, mouth), 1.85F);
  const auto foot = [](const Eigen::Vector3f& v) {
    return within(v.z(), 0.26F, 0.33F) && std::abs(v.x()) > 1.30F;
  };
  EXPECT_NEAR(-reach_m(mesh, kX, foot), 1.36F, 0.01F);
}

TEST(Magellan, MediumGainConeStandsOnPlusYOnly) {
  const TriangleMesh mesh = make_magellan();
  const auto cone = [](const Eigen::Vector3f& v) {
    return within(v.z(), -0.59F, 0.11F) && std::abs(v.x()) < 0.30F;
  };
  EXPECT_NEAR(reach_m(mesh, kY, cone), 1.81F, 0.01F);
  EXPECT_LT(reach_m(mesh, -kY, cone), 0.95F);
  const auto mouth = [](const Eigen::Vector3f& v) { return v.y() > 1.55F && within(v.z(), -0.31F, 0.11F); };
  EXPECT_NEAR(reach_m(mesh, kX, mouth), 0.23F, 0.01F);
}

}  // namespace
}  // namespace tumblesight::sim
