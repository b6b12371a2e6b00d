// Verifies TS-SIL-070. An occluder of any shape covers the part of the frame that it should, nearer than the
// range that the estimator uses.
#include "sim/world/sensor/occlusion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kRays = 128;
constexpr double kTargetRange_m = 30.0;

// A disc that fills most of the frame.
RangeGrid disc() {
  RangeGrid grid{kRays, 0.1, std::vector<double>(kRays * kRays, std::numeric_limits<double>::infinity())};
  for (int row = 0; row < kRays; ++row) {
    for (int column = 0; column < kRays; ++column) {
      if (std::hypot(grid.slope(row), grid.slope(column)) < 0.08)
        grid.range_m[row * kRays + column] = kTargetRange_m;
    }
  }
  return grid;
}

Occluder occluder(OccluderShape shape, double hidden_share, double side_rad, double across = 0.5) {
  return {shape, side_rad, across, hidden_share, 3.0};
}

// Whether a ray is blocked, given by its slopes to the right and up in units of the half frame.
bool blocked(const RangeGrid& grid, double right, double up) {
  const auto index = [&](double at) {
    return std::min(kRays - 1, static_cast<int>((at + 1.0) / 2.0 * kRays));
  };
  return grid.range_m[index(-up) * kRays + index(right)] < 10.0;
}

bool blocked_along(const RangeGrid& grid, double side_rad, double along, double across = 0.0) {
  const double x = std::cos(side_rad), y = std::sin(side_rad);
  return blocked(grid, along * x - across * y, along * y + across * x);
}

TEST(Occlude, HidesTheWantedShareOfTheReturnsOfARealTarget) {
  const TriangleMesh mesh = make_near_shoemaker();
  const FlashLidar lidar(mesh);
  int index = 0;
  for (const OccluderShape shape : {OccluderShape::kArm, OccluderShape::kMast, OccluderShape::kPanelEdge}) {
    for (const double share : {0.05, 0.15, 0.30}) {
      for (int view = 0; view < 4; ++view) {
        const FrameTruth truth = make_sequence({Condition::kNominal, 1}, 5, ++index).frames[0];
        const RangeGrid open = lidar.true_ranges(truth, kRays, swath_m(mesh));
        RangeGrid covered = open;
        occlude(occluder(shape, share, 0.3 + 1.7 * index, 0.15 + 0.7 * std::fmod(0.37 * index, 1.0)),
                covered);
        int returns = 0, hidden = 0;
        for (std::size_t i = 0; i < open.range_m.size(); ++i) {
          const bool target = std::isfinite(open.range_m[i]);
          returns += target;
          if (covered.range_m[i] == open.range_m[i]) continue;
          hidden += target;
          ASSERT_LT(covered.range_m[i], 10.0) << "a blocked ray must see the occluder";
          ASSERT_GE(covered.range_m[i], 3.0);
        }
        ASSERT_GT(returns, 500);
        EXPECT_NEAR(hidden, share * returns, 2.0) << static_cast<int>(shape) << ' ' << share << ' ' << view;
      }
    }
  }
}

TEST(Occlude, TheArmReachesInFromItsSideAndEndsOverTheTarget) {
  for (const double side_rad : {0.01, 1.58, 2.4, 4.0, 5.5}) {
    RangeGrid grid = disc();
    occlude(occluder(OccluderShape::kArm, 0.1, side_rad), grid);
    EXPECT_TRUE(blocked_along(grid, side_rad, 0.97)) << side_rad;
    EXPECT_FALSE(blocked_along(grid, side_rad, -0.97)) << side_rad;
    EXPECT_FALSE(blocked_along(grid, side_rad, -0.6)) << side_rad;
    EXPECT_FALSE(blocked_along(grid, side_rad, 0.6, 0.6)) << "an arm is slim";
    EXPECT_FALSE(blocked_along(grid, side_rad, 0.6, -0.6)) << "an arm is slim";
  }
}

TEST(Occlude, TheArmReachesInAtItsPositionAcrossTheTarget) {
  // `across` is the share of the returns to the left of the axis, seen from the arm's side: below it, from
  // the right.
  RangeGrid low = disc(), high = disc();
  occlude(occluder(OccluderShape::kArm, 0.05, 0.0, 0.2), low);
  occlude(occluder(OccluderShape::kArm, 0.05, 0.0, 0.8), high);
  EXPECT_TRUE(blocked(low, 0.97, -0.4));
  EXPECT_FALSE(blocked(low, 0.97, 0.4));
  EXPECT_TRUE(blocked(high, 0.97, 0.4));
  EXPECT_FALSE(blocked(high, 0.97, -0.4));
}

TEST(Occlude, TheMastCrossesTheWholeFrame) {
  for (const double side_rad : {0.01, 1.58, 2.4, 4.0}) {
    RangeGrid grid = disc();
    occlude(occluder(OccluderShape::kMast, 0.2, side_rad), grid);
    for (const double along : {-0.97, -0.5, 0.0, 0.5, 0.97}) {
      EXPECT_TRUE(blocked_along(grid, side_rad, along)) << side_rad << ' ' << along;
      if (std::abs(along) > 0.7) continue;
      EXPECT_FALSE(blocked_along(grid, side_rad, along, 0.7)) << side_rad << ' ' << along;
      EXPECT_FALSE(blocked_along(grid, side_rad, along, -0.7)) << side_rad << ' ' << along;
    }
  }
}

TEST(Occlude, ThePanelCoversEverythingBeyondAStraightEdge) {
  const double side_rad = 2.4;
  RangeGrid grid = disc();
  occlude(occluder(OccluderShape::kPanelEdge, 0.3, side_rad), grid);
  double nearest_open = -10.0, farthest_blocked = 10.0;  // along the axis towards the panel's side
  for (int row = 0; row < kRays; ++row) {
    for (int column = 0; column < kRays; ++column) {
      const double along = std::cos(side_rad) * grid.slope(column) - std::sin(side_rad) * grid.slope(row);
      if (grid.range_m[row * kRays + column] < 10.0) {
        farthest_blocked = std::min(farthest_blocked, along);
      } else {
        nearest_open = std::max(nearest_open, along);
      }
    }
  }
  EXPECT_LE(nearest_open, farthest_blocked);
  EXPECT_NEAR(farthest_blocked, 0.08 * 0.32, 0.08 * 0.03);  // 30 % of a disc lie beyond 0.32 radii
}

TEST(Occlude, LeavesAFrameWithoutReturnsAndOneWithoutOccluderUntouched) {
  RangeGrid empty = disc();
  empty.range_m.assign(empty.range_m.size(), std::numeric_limits<double>::infinity());
  const RangeGrid before = empty;
  occlude(occluder(OccluderShape::kPanelEdge, 0.3, 1.0), empty);
  EXPECT_EQ(empty.range_m, before.range_m);

  for (const Occluder& nothing :
       {Occluder{}, occluder(OccluderShape::kNone, 0.3, 1.0), occluder(OccluderShape::kMast, 0.0, 1.0)}) {
    RangeGrid grid = disc();
    occlude(nothing, grid);
    EXPECT_EQ(grid.range_m, disc().range_m);
  }
}

TEST(Occlude, HidesASingleReturnAndTheWholeTargetIfRequested) {
  RangeGrid one = disc();
  one.range_m.assign(one.range_m.size(), std::numeric_limits<double>::infinity());
  one.range_m[40 * kRays + 70] = kTargetRange_m;
  for (const OccluderShape shape : {OccluderShape::kArm, OccluderShape::kMast, OccluderShape::kPanelEdge}) {
    RangeGrid grid = one;
    occlude(occluder(shape, 0.1, 1.0), grid);
    EXPECT_LT(grid.range_m[40 * kRays + 70], 10.0);
    RangeGrid all = disc();
    occlude(occluder(shape, 1.0, 1.0), all);
    for (const double range_m : all.range_m) ASSERT_NE(range_m, kTargetRange_m);
  }
}

}  // namespace
}  // namespace tumblesight::sim
