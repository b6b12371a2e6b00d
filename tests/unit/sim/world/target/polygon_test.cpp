#include "sim/world/target/polygon.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace tumblesight::sim {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

double area_of_triangles(const Corners& corners, const DividedPolygon& polygon) {
  double area = 0.0;
  for (const auto& [a, b, c] : polygon.triangles)
    area += 0.5 * (corners[b] - corners[a]).cross(corners[c] - corners[a]).norm();
  return area;
}

void expect_whole(const Corners& corners, const char* what) {
  const DividedPolygon polygon = divided(corners);
  EXPECT_TRUE(polygon.is_whole) << what;
  EXPECT_EQ(polygon.triangles.size(), corners.size() - 2) << what;
  EXPECT_NEAR(area_of_triangles(corners, polygon), area_of(corners), 1e-9 * area_of(corners)) << what;
}

// Every simple polygon of n corners has n - 2 triangles, and their areas add up to its own.
TEST(Polygon, IsDividedWithoutLossInAnyPlane) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const int count = 5 + i % 60;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), 1.0).normalized();
    Corners star;
    for (int k = 0; k < count; ++k) {
      const double angle = 6.283185307179586 * k / count, radius = 0.1 + uniform(random);
      star.push_back(turn * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0));
    }
    if (i % 2 == 0) std::reverse(star.begin(), star.end());
    expect_whole(star, "a star");
  }
}

TEST(Polygon, WithCornersOnItsEdgesIsWhole) {
  expect_whole({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},
               "a square");
  expect_whole({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 3, 0}}, "a triangle of four corners");
}

TEST(Polygon, WithABridgeToItsHoleIsWhole) {
  expect_whole({{0, 0, 0},
                {4, 0, 0},
                {4, 4, 0},
                {0, 4, 0},
                {0, 0, 0},
                {1, 1, 0},
                {1, 3, 0},
                {3, 3, 0},
                {3, 1, 0},
                {1, 1, 0}},
               "a frame");
}

TEST(Polygon, WhoseFirstCornerComesAgainIsTheSame) {
  const Corners corners{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}, {0, 0, 0}};
  const DividedPolygon polygon = divided(corners);
  EXPECT_TRUE(polygon.is_whole);
  EXPECT_EQ(polygon.triangles.size(), 3U);
}

// The dart's diagonal must lie inside.
TEST(Polygon, AConcaveQuadrangleIsWhole) {
  const Corners dart{{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
  for (std::size_t first = 0; first < 4; ++first) {
    Corners turned = dart;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
    expect_whole(turned, "a dart");
  }
}

TEST(Polygon, OfCrossingEdgesOrWithoutAreaEnds) {
  Corners crossing;
  for (int i = 0; i < 7; ++i)
    crossing.emplace_back(std::cos(2.0 * 6.283185307179586 * i / 7),
                          std::sin(2.0 * 6.283185307179586 * i / 7), 0.0);
  (void)divided(crossing);
  EXPECT_FALSE(divided({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).is_whole);
  EXPECT_EQ(divided(Corners(9, Eigen::Vector3d::Zero())).triangles.size(), 1U);
}

TEST(Polygon, OfTheMostCornersTakesNoTime) {
  Corners comb{{0, 0, 0}};
  for (std::size_t i = 1; i < kMostCorners; ++i) comb.emplace_back(i, i % 4 < 2 ? 1.0 : 50.0, 0.0);
  comb.back().y() = 0.0;
  expect_whole(comb, "a comb");
}

}  // namespace
}  // namespace tumblesight::sim
