#include "sim/world/target/polygon.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tests/unit/sim/world/target/refused_text.hpp"

namespace tumblesight::sim {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

constexpr auto kNone = DividedPolygon::Fault::kNone;
constexpr auto kCrossing = DividedPolygon::Fault::kCrossing;

DividedPolygon divided(const Corners& corners) {
  long tests = 200'000'000;
  return sim::divided(corners, tests);
}

double area_of_triangles(const Corners& corners, const DividedPolygon& polygon) {
  double area = 0.0;
  for (const auto& [a, b, c] : polygon.triangles)
    area += 0.5 * (corners[b] - corners[a]).cross(corners[c] - corners[a]).norm();
  return area;
}

void expect_whole(const Corners& corners, const char* what) {
  const DividedPolygon polygon = divided(corners);
  EXPECT_EQ(polygon.fault, kNone) << what;
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
  EXPECT_EQ(polygon.fault, kNone);
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
  EXPECT_EQ(divided({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).fault, kCrossing);
  EXPECT_EQ(divided(Corners(9, Eigen::Vector3d::Zero())).triangles.size(), 1U);
}

TEST(Polygon, WhoseEdgesCrossIsKnown) {
  EXPECT_EQ(divided({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).fault, kCrossing) << "a bow tie";
  EXPECT_NEAR(divided({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).wrong_area, 0.5, 1e-9);
  EXPECT_EQ(divided({{0, 0, 0}, {1, 1, 0.1}, {1, 0, 0}, {0, 2, 0}}).fault, kCrossing)
      << "one that is not flat";
  EXPECT_EQ(divided({{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}}).fault, kNone) << "a saddle";
  EXPECT_EQ(divided({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}}).fault, kNone);
  EXPECT_EQ(divided({{0, 0, 0}, {3, 2, 0}, {4, 2, 0}, {4, 0, 0}, {3, 0, 0}, {0, 1, 0}}).fault, kCrossing);
  Corners pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.emplace_back(std::cos(2.0 * 6.283185307179586 * i / 5),
                           std::sin(2.0 * 6.283185307179586 * i / 5), 0.0);
  EXPECT_EQ(divided(pentagram).fault, kCrossing);
}

TEST(Polygon, WhosePartsCancelEachOtherLacksThem) {
  const DividedPolygon eight = divided({{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 1, 0}, {-1, 0.5, 0}, {0, 0, 0}});
  EXPECT_EQ(eight.fault, kCrossing);
  const DividedPolygon bow = divided({{0, 0, 0}, {1, 0.5, 0}, {2, 1, 0}, {2, 0, 0}, {1, 0.5, 0}, {0, 1, 0}});
  EXPECT_EQ(bow.fault, kCrossing);
  EXPECT_GT(bow.wrong_area, 0.3);
}

// As a spring of sheet metal: every corner's triangle is near the corners of the neighbouring turns.
Corners spiral(int count, double z = 0.0) {
  Corners corners;
  const auto add = [&](double from, int i) {
    corners.emplace_back((from + 0.001 * i) * std::cos(0.1 * i), (from + 0.001 * i) * std::sin(0.1 * i), z);
  };
  for (int i = 0; i < count; ++i) add(0.1, i);
  for (int i = count - 1; i >= 0; --i) add(0.13, i);
  return corners;
}

TEST(Polygon, OfManyTurnsIsWhole) {
  expect_whole(spiral(400), "a spiral");
}

TEST(PolygonDivider, AFileOfLongPolygonsIsWhole) {
  PolygonDivider polygons;
  for (int i = 0; i < 2; ++i) EXPECT_EQ(polygons.divide(spiral(2400, i), 1).size(), 4798U);
  EXPECT_EQ(polygons.loss("line"), "");
}

TEST(PolygonDivider, SaysWhatIsWrongAndHowMuch) {
  PolygonDivider polygons;
  (void)polygons.divide({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, 1);
  (void)polygons.divide({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, 7);
  const std::string loss = polygons.loss("line");
  for (const char* part : {"1 polygon of 2", "line 7", "edges cross", "3.03 %", "missing or wrong"})
    EXPECT_NE(loss.find(part), std::string::npos) << loss;
}

TEST(PolygonDivider, RefusesAFileOfWhichMuchIsWrong) {
  PolygonDivider polygons;
  (void)polygons.divide({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1);
  (void)polygons.divide({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, 7);
  expect_refusal([&] { (void)polygons.loss("face"); },
                 {"1 polygon of 2", "face 7", "33.3 %", "at most 20 %", "riangulate"});
}

// The tests are counted for the file, and the reason is the true one.
TEST(PolygonDivider, OfTangledPolygonsEnds) {
  PolygonDivider polygons;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    Corners tangle;
    for (std::size_t k = 0; k < kMostCorners; ++k) tangle.emplace_back(uniform(random), uniform(random), 0.0);
    (void)polygons.divide(tangle, 3);
  }
  expect_refusal([&] { (void)polygons.loss("line"); }, {"of 20", "line 3", "missing or wrong"});
}

TEST(Polygon, WithoutTestsLeftSaysSo) {
  long tests = 1000;
  EXPECT_EQ(sim::divided(spiral(400), tests).fault, DividedPolygon::Fault::kNoTestsLeft);
}

TEST(Polygon, OfTheMostCornersTakesNoTime) {
  Corners comb{{0, 0, 0}};
  for (std::size_t i = 1; i < kMostCorners; ++i) comb.emplace_back(i, i % 4 < 2 ? 1.0 : 50.0, 0.0);
  comb.back().y() = 0.0;
  expect_whole(comb, "a comb");
}

}  // namespace
}  // namespace tumblesight::sim
