// Verifies TS-SIL-300. Which parts are solar panels.
#include "sim/world/target/panels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/world/target/primitives.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

TriangleMesh unmarked(TriangleMesh mesh) {
  mesh.is_panel.clear();
  return mesh;
}

TEST(Panels, OfTheShippedTargetsAreMarked) {
  struct Expected {
    const char* target;
    std::size_t panels;
    double centre_m;  // distance of each from the z axis
    double area_m2;   // of each, both sides and edges
    double tolerance_m2;
  };
  for (const Expected& expected : {Expected{"near_shoemaker", 4, 1.7335, 4.57, 0.05},
                                   {"magellan", 2, 3.311, 12.57, 0.05},
                                   {"sacd_aquarius", 2, 1.4865, 9.1, 0.2},
                                   {"sacd_aquarius_stowed", 2, 0.723, 9.1, 0.2}}) {
    const TriangleMesh mesh = target_by_name(expected.target);
    const std::vector<Panel> panels = find_panels(mesh);
    ASSERT_EQ(panels.size(), expected.panels) << expected.target;
    for (const Panel& panel : panels) {
      EXPECT_NEAR(panel.centre_trf_m.head<2>().norm(), expected.centre_m, 0.05) << expected.target;
      EXPECT_NEAR(area_m2(mesh, panel.triangles), expected.area_m2, expected.tolerance_m2) << expected.target;
      EXPECT_NEAR(panel.hinge_trf.dot(panel.normal_trf), 0.0, 1e-3) << expected.target;
      EXPECT_GE(panel.hinge_trf.dot(panel.centre_trf_m), 0.0) << expected.target;
    }
  }
}

TEST(Panels, TurnAboutTheAxisThatPointsAwayFromTheBody) {
  for (const Panel& panel : find_panels(target_by_name("near_shoemaker"))) {
    const Eigen::Vector3d outwards(panel.centre_trf_m.x(), panel.centre_trf_m.y(), 0.0);
    EXPECT_LT((panel.hinge_trf - outwards.normalized()).norm(), 1e-4);
  }
  for (const Panel& panel : find_panels(target_by_name("magellan"))) {
    EXPECT_NEAR(std::abs(panel.hinge_trf.x()), 1.0, 1e-4);
  }
}

TEST(Panels, AreFoundByTheirShapeWithoutMarks) {
  for (const char* target : {"near_shoemaker", "magellan"}) {
    const TriangleMesh mesh = target_by_name(target);
    std::vector<std::uint8_t> found(mesh.triangles.size());
    for (const Panel& panel : find_panels(unmarked(mesh))) {
      for (const std::size_t triangle : panel.triangles) found[triangle] = 1;
    }
    EXPECT_EQ(found, mesh.is_panel) << target;
  }
}

TEST(Panels, AreNotFoundOnABodyWithout) {
  EXPECT_TRUE(find_panels(box({1.0F, 1.0F, 1.0F})).empty());
  EXPECT_TRUE(find_panels(revolve({{0.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}}, 32)).empty());
}

// A plate of cells just above a panel, and a panel far off in the same plane.
TEST(Panels, TakePlatesThatTouchAsOne) {
  TriangleMesh mesh = box({1.0F, 1.0F, 1.0F});
  append(mesh, box_between({1.0F, -0.5F, 0.0F}, {3.0F, 0.5F, 0.02F}));
  append(mesh, cap({{1.1F, -0.4F, 0.03F}, {2.9F, -0.4F, 0.03F}, {2.9F, 0.4F, 0.03F}, {1.1F, 0.4F, 0.03F}}));
  append(mesh, box_between({-3.0F, -0.5F, 0.0F}, {-1.0F, 0.5F, 0.02F}));
  const std::vector<Panel> panels = find_panels(mesh);
  ASSERT_EQ(panels.size(), 2U);
  EXPECT_EQ(std::max(panels[0].triangles.size(), panels[1].triangles.size()), 12U + 2U);
  EXPECT_EQ(std::min(panels[0].triangles.size(), panels[1].triangles.size()), 12U);
}

// A marked plate that shares two corners with the body.
TEST(Panels, EndWhereTheirMarkEnds) {
  TriangleMesh mesh = box({2.0F, 2.0F, 2.0F});
  append(mesh,
         as_panel(cap({{1.0F, -1.0F, 1.0F}, {1.0F, 1.0F, 1.0F}, {3.0F, 1.0F, 1.0F}, {3.0F, -1.0F, 1.0F}})));
  const std::vector<Panel> panels = find_panels(mesh);
  ASSERT_EQ(panels.size(), 1U);
  EXPECT_EQ(panels[0].triangles, (std::vector<std::size_t>{12, 13}));
  EXPECT_LT((panels[0].centre_trf_m - Eigen::Vector3d(2.0, 0.0, 1.0)).norm(), 1e-6);
  EXPECT_LT((panels[0].hinge_trf - Eigen::Vector3d(1.0, 0.0, 0.0)).norm(), 1e-6);
}

TEST(ConnectedParts, ShareCornersAtTheSamePlace) {
  TriangleMesh mesh = box({1.0F, 1.0F, 1.0F});
  append(mesh, cap({{0.5F, 0.5F, 0.5F}, {2.0F, 0.0F, 0.0F}, {2.0F, 1.0F, 0.0F}}));  // at a corner of the box
  append(mesh, box_between({3.0F, 0.0F, 0.0F}, {4.0F, 1.0F, 1.0F}));
  const auto parts = connected_parts(mesh);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].size(), 13U);
  EXPECT_EQ(parts[1].size(), 12U);
  EXPECT_NEAR(area_m2(mesh, parts[1]), 6.0, 1e-6);
}

}  // namespace
}  // namespace tumblesight::sim
