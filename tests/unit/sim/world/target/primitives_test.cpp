#include "sim/world/target/primitives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/unit/sim/world/target/mesh_measures.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kPi = 3.14159265358979;

TEST(Primitives, BoxHasItsAreaAndVolumeAndStaysClosedWhenPlaced) {
  Eigen::Isometry3f pose(Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1.0F, 2.0F, 3.0F).normalized()));
  pose.pretranslate(Eigen::Vector3f(0.5F, -2.0F, 1.0F));
  const TriangleMesh mesh = placed(box({1.0F, 2.0F, 3.0F}), pose);
  EXPECT_NEAR(area_m2(mesh), 22.0, 1e-4);
  EXPECT_NEAR(volume_m3(mesh, {0.5, -2.0, 1.0}), 6.0, 1e-4);
  EXPECT_DOUBLE_EQ(closed_edge_share(mesh), 1.0);
}

TEST(Primitives, FrustumOfASquarePyramidHasItsVolume) {
  const float root_half = std::sqrt(0.5F);  // corner radius of a unit square
  const TriangleMesh mesh = frustum(4, 2.0F * root_half, root_half, 0.0F, 3.0F);
  EXPECT_NEAR(volume_m3(mesh, {0.0, 0.0, 1.5}), 3.0 / 3.0 * (4.0 + 1.0 + 2.0), 1e-4);
  EXPECT_DOUBLE_EQ(closed_edge_share(mesh), 1.0);
}

TEST(Primitives, RevolvedHalfCircleIsASphere) {
  Outline profile;
  for (int i = 0; i <= 60; ++i) {
    const double polar = kPi * i / 60.0;
    profile.emplace_back(i % 60 == 0 ? 0.0 : 2.0 * std::sin(polar), 2.0 * std::cos(polar));
  }
  const TriangleMesh mesh = revolve(profile, 120);
  EXPECT_NEAR(area_m2(mesh), 16.0 * kPi, 0.002 * 16.0 * kPi);
  EXPECT_NEAR(volume_m3(mesh, Eigen::Vector3d::Zero()), 32.0 / 3.0 * kPi, 0.003 * 32.0 / 3.0 * kPi);
  EXPECT_DOUBLE_EQ(closed_edge_share(mesh), 1.0);
}

TEST(Primitives, RevolvedProfileOffTheAxisStaysOpen) {
  const TriangleMesh mesh = revolve({{1.0F, 0.0F}, {1.0F, 2.0F}}, 200);
  EXPECT_NEAR(area_m2(mesh), 4.0 * kPi, 0.001 * 4.0 * kPi);
  EXPECT_LT(closed_edge_share(mesh), 1.0);
}

TEST(Primitives, TubeJoinsItsTwoPoints) {
  const Eigen::Vector3f from(1.0F, -1.0F, 0.5F);
  const Eigen::Vector3f to(1.0F, 2.0F, 4.5F);  // 5 m away
  const TriangleMesh mesh = tube(from, to, 0.2F, 0.2F, 180);
  EXPECT_NEAR(volume_m3(mesh, ((from + to) / 2.0F).cast<double>()), kPi * 0.04 * 5.0, 0.001);
  const Eigen::Vector3f axis = (to - from).normalized();
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m) {
    EXPECT_NEAR(axis.cross(v - from).norm(), 0.2F, 1e-5F);
  }
}

TEST(Primitives, TubeMayPointStraightDown) {
  const TriangleMesh mesh = tube({0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, -1.0F}, 0.1F, 0.1F, 8);
  EXPECT_NEAR(bounding_box(mesh).min().z(), -1.0F, 1e-6F);
  EXPECT_NEAR(bounding_box(mesh).max().z(), 1.0F, 1e-6F);
}

TEST(Primitives, UprightPrismRunsAlongItsHeadingAndToItsLeft) {
  const Outline profile = {{1.0F, 0.0F}, {2.0F, 0.0F}, {2.0F, 5.0F}, {1.0F, 5.0F}};
  const float to_y = static_cast<float>(kPi / 2.0);
  const Eigen::AlignedBox3f bounds = bounding_box(upright_prism(profile, to_y, 0.0F, 3.0F));
  EXPECT_TRUE(bounds.min().isApprox(Eigen::Vector3f(-3.0F, 1.0F, 0.0F), 1e-6F)) << bounds.min().transpose();
  EXPECT_TRUE(bounds.max().isApprox(Eigen::Vector3f(0.0F, 2.0F, 5.0F), 1e-6F)) << bounds.max().transpose();
}

TEST(Primitives, AppendedPartsKeepTheirTriangles) {
  TriangleMesh mesh = box({1.0F, 1.0F, 1.0F});
  mesh.name = "whole";
  append(mesh, placed(box({1.0F, 1.0F, 1.0F}), Eigen::Isometry3f(Eigen::Translation3f(5.0F, 0.0F, 0.0F))));
  EXPECT_EQ(mesh.name, "whole");
  EXPECT_NEAR(area_m2(mesh), 12.0, 1e-5);
  EXPECT_NEAR(bounding_box(mesh).max().x(), 5.5F, 1e-6F);
}

TEST(Primitives, MirrorImageLiesAcrossTheAxisAndLeavesThePart) {
  const TriangleMesh part = box_between({1.0F, -1.0F, 0.0F}, {2.0F, 3.0F, 5.0F});
  const Eigen::AlignedBox3f image = bounding_box(mirrored(part, 1));
  EXPECT_TRUE(image.min().isApprox(Eigen::Vector3f(1.0F, -3.0F, 0.0F), 1e-6F)) << image.min().transpose();
  EXPECT_TRUE(image.max().isApprox(Eigen::Vector3f(2.0F, 1.0F, 5.0F), 1e-6F)) << image.max().transpose();
  const TriangleMesh both = with_mirror_image(part, 0);
  EXPECT_NEAR(area_m2(both), 2.0 * area_m2(part), 1e-4);
  EXPECT_NEAR(bounding_box(both).min().x(), -2.0F, 1e-6F);
  EXPECT_NEAR(bounding_box(both).max().x(), 2.0F, 1e-6F);
}

TEST(Primitives, StripJoinsItsChainsAndStaysOpen) {
  const Loop from = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 0.0F}};
  const Loop to = {{0.0F, 2.0F, 0.0F}, {1.0F, 2.0F, 0.0F}, {3.0F, 2.0F, 0.0F}};
  EXPECT_NEAR(area_m2(strip(from, to)), 6.0, 1e-5);
}

TEST(Primitives, FrameIsRightHandedWithTheGivenAxes) {
  const Eigen::Isometry3f pose = frame_at({1.0F, 2.0F, 3.0F}, {0.0F, 2.0F, 0.0F}, {0.0F, 1.0F, 4.0F});
  EXPECT_TRUE((pose * Eigen::Vector3f(1.0F, 0.0F, 0.0F)).isApprox(Eigen::Vector3f(1.0F, 3.0F, 3.0F), 1e-6F));
  EXPECT_TRUE((pose * Eigen::Vector3f(0.0F, 1.0F, 0.0F)).isApprox(Eigen::Vector3f(1.0F, 2.0F, 4.0F), 1e-6F));
  EXPECT_TRUE((pose * Eigen::Vector3f(0.0F, 0.0F, 1.0F)).isApprox(Eigen::Vector3f(2.0F, 2.0F, 3.0F), 1e-6F));
  EXPECT_TRUE((turned(static_cast<float>(kPi / 2.0)) * Eigen::Vector3f::UnitX())
                  .isApprox(Eigen::Vector3f::UnitY(), 1e-6F));
}

TEST(Primitives, ImpossibleSizesAreRefused) {
  EXPECT_THROW(box({1.0F, 0.0F, 1.0F}), std::invalid_argument);
  EXPECT_THROW(box({1.0F, -1.0F, 1.0F}), std::invalid_argument);
  EXPECT_THROW(cap({{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}}), std::invalid_argument);
  EXPECT_THROW(band(Loop(3, Eigen::Vector3f::Zero()), Loop(4, Eigen::Vector3f::Zero())),
               std::invalid_argument);
  EXPECT_THROW(strip({{0.0F, 0.0F, 0.0F}}, {{1.0F, 0.0F, 0.0F}}), std::invalid_argument);
  EXPECT_THROW(box_between({1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 1.0F}), std::invalid_argument);
  EXPECT_THROW(frustum(2, 1.0F, 1.0F, 0.0F, 1.0F), std::invalid_argument);
  EXPECT_THROW(frustum(6, 1.0F, 1.0F, 1.0F, 1.0F), std::invalid_argument);
  EXPECT_THROW(revolve({{1.0F, 0.0F}}, 8), std::invalid_argument);
  EXPECT_THROW(revolve({{0.0F, 0.0F}, {0.0F, 1.0F}}, 8), std::invalid_argument);
  EXPECT_THROW(tube(Eigen::Vector3f::Ones(), Eigen::Vector3f::Ones(), 0.1F, 0.1F, 6), std::invalid_argument);
}

}  // namespace
}  // namespace tumblesight::sim
