// Distances agree with the drawn shape. Dropouts inside it and edges of the chaser's own parts do not count
// as silhouette.
#include "sim/baseline/silhouette.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace tumblesight::sim {
namespace {

// A disc of returns at 40 m with a radius of 20 rays in the centre of 101 x 101 rays.
std::unique_ptr<gnc::RangeImage> disc() {
  auto frame = std::make_unique<gnc::RangeImage>();
  frame->rays = 101;
  frame->fov_urad = 150'000;
  for (int row = 0; row < 101; ++row) {
    for (int column = 0; column < 101; ++column) {
      if (std::hypot(row - 50, column - 50) <= 20.0) frame->ranges[row * 101 + column] = 40 * 128;
    }
  }
  return frame;
}

TEST(SilhouetteField, MeasuresTheDistanceToADisc) {
  const SilhouetteField silhouette(*scan_of(*disc()));
  for (const double radius : {8.0, 17.5, 19.0, 22.0, 30.0}) {
    for (int i = 0; i < 48; ++i) {
      const double angle = M_PI * i / 24;
      SilhouetteField::Distance distance;
      ASSERT_TRUE(silhouette.at(50 + radius * std::cos(angle), 50 - radius * std::sin(angle), distance));
      EXPECT_NEAR(distance.out_rays, radius - 20.25, 0.9) << radius << ' ' << i;
      EXPECT_GT(distance.outwards.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle))),
                0.69);  // 45 degrees: next to the silhouette a step goes to one of 8 neighbours
    }
  }
}

TEST(SilhouetteField, FillsDropouts) {
  auto frame = disc();
  frame->ranges[50 * 101 + 50] = 0;
  frame->ranges[50 * 101 + 53] = 0;
  const auto scan = scan_of(*frame);
  EXPECT_EQ(scan->kind[50 * 101 + 53], RayKind::kLost);
  SilhouetteField::Distance distance;
  ASSERT_TRUE(SilhouetteField(*scan).at(53, 50, distance));
  EXPECT_NEAR(distance.out_rays, -17.0, 0.9);
}

TEST(SilhouetteField, IsUnknownBesideAPartOfTheChaserAndOutsideTheFrame) {
  auto frame = disc();
  for (int row = 0; row < 101; ++row) frame->ranges[row * 101 + 60] = 3 * 128;
  const SilhouetteField silhouette(*scan_of(*frame));
  SilhouetteField::Distance distance;
  EXPECT_FALSE(silhouette.at(60, 50, distance));
  EXPECT_FALSE(silhouette.at(58, 50, distance));
  EXPECT_TRUE(silhouette.at(32, 50, distance));
  EXPECT_FALSE(silhouette.at(-1, 50, distance));
  EXPECT_FALSE(silhouette.at(50, 101, distance));
}

}  // namespace
}  // namespace tumblesight::sim
