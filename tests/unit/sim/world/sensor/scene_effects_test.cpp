// Verifies TS-SIL-300. What else is in view, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kRays = 128;
constexpr double kRange_m = 40.0;
constexpr double kSwath_m = 6.3;
constexpr double kWide = 0.13;  // tangent of half a view that holds debris wherever it is drawn
constexpr double kNone = std::numeric_limits<double>::infinity();

const FrameTruth kTruth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), kRange_m};
const std::array<Eigen::Vector3f, 6> kCorners{};
const Flash kFlash{kTruth, kSwath_m, kCorners};

RangeGrid empty_grid(double tan_half_fov = kSwath_m / (2.0 * kRange_m)) {
  RangeGrid grid;
  grid.rays = kRays;
  grid.tan_half_fov = tan_half_fov;
  grid.range_m.assign(kRays * kRays, kNone);
  return grid;
}

EffectRandom random_of(std::uint64_t frame, std::uint64_t sequence = 7) {
  return {Random(frame), Random(sequence)};
}

// Along the boresight per unit of range.
double depth_share(const RangeGrid& grid, int ray) {
  const double x = grid.slope(ray % kRays), y = grid.slope(ray / kRays);
  return 1.0 / std::sqrt(1.0 + x * x + y * y);
}

int returns(const RangeGrid& grid) {
  return static_cast<int>(
      std::count_if(grid.range_m.begin(), grid.range_m.end(), [](double r) { return std::isfinite(r); }));
}

TEST(SceneEffects, BackgroundFillsItsShareThirtyMetresBehindTheTarget) {
  for (const double share : {0.25, 0.5, 1.0}) {
    for (std::uint64_t sequence = 0; sequence < 5; ++sequence) {
      RangeGrid grid = empty_grid();
      EffectRandom random = random_of(1, sequence);
      add_background(share, kFlash, random, grid);
      EXPECT_NEAR(returns(grid), share * kRays * kRays, 2.0);
      for (int i = 0; i < kRays * kRays; ++i) {
        if (!std::isfinite(grid.range_m[i])) continue;
        EXPECT_NEAR(grid.range_m[i] * depth_share(grid, i), 70.0, 1e-9);
      }
    }
  }
}

TEST(SceneEffects, BackgroundLiesOnOneSideBehindTheTargetAndStaysThroughASequence) {
  RangeGrid grid = empty_grid(), later = empty_grid(), covered = empty_grid();
  std::fill(covered.range_m.begin(), covered.range_m.end(), kRange_m);
  EffectRandom one = random_of(1), two = random_of(2), three = random_of(1);
  add_background(0.5, kFlash, one, grid);
  add_background(0.5, kFlash, two, later);
  add_background(0.5, kFlash, three, covered);
  EXPECT_EQ(grid.range_m, later.range_m);
  EXPECT_EQ(covered.range_m, std::vector<double>(kRays * kRays, kRange_m));
  // Through the middle, a ray and the opposite one are on different sides.
  int both = 0;
  for (int i = 0; i < kRays * kRays / 2; ++i)
    both += std::isfinite(grid.range_m[i]) == std::isfinite(grid.range_m[kRays * kRays - 1 - i]);
  EXPECT_LE(both, 2);
}

// A sphere of radius r at distance d covers a disc of tan(asin(r / d)); its nearest point is at d - r.
TEST(SceneEffects, DebrisIsASphereOfItsDiameter) {
  double nearest_m = kNone, farthest_m = 0.0;
  for (std::uint64_t sequence = 0; sequence < 50; ++sequence) {
    RangeGrid grid = empty_grid(kWide);
    EffectRandom random = random_of(1, sequence), again = random_of(2, sequence);
    add_debris(1.5, kFlash, random, grid);
    RangeGrid later = empty_grid(kWide);
    add_debris(1.5, kFlash, again, later);
    EXPECT_EQ(grid.range_m, later.range_m);
    const double entry_m = *std::min_element(grid.range_m.begin(), grid.range_m.end());
    const double radius = std::tan(std::asin(0.75 / (entry_m + 0.75))) / (2.0 * kWide) * kRays;
    EXPECT_NEAR(returns(grid), kPi * radius * radius, 0.06 * kPi * radius * radius) << sequence;
    nearest_m = std::min(nearest_m, entry_m);
    farthest_m = std::max(farthest_m, entry_m);
  }
  // Within half a swath of the target; centres are farther off near the corners of the view.
  EXPECT_GT(nearest_m, kRange_m - 0.5 * kSwath_m - 0.76);
  EXPECT_LT(farthest_m, kRange_m + 0.5 * kSwath_m - 0.5);
  EXPECT_GT(farthest_m - nearest_m, 0.8 * kSwath_m);
}

TEST(SceneEffects, DebrisHidesWhatIsBehindItAndNotWhatIsInFront) {
  RangeGrid behind = empty_grid(), in_front = empty_grid();
  std::fill(behind.range_m.begin(), behind.range_m.end(), 100.0);
  std::fill(in_front.range_m.begin(), in_front.range_m.end(), 20.0);
  EffectRandom one = random_of(1), two = random_of(1);
  add_debris(1.5, kFlash, one, behind);
  add_debris(1.5, kFlash, two, in_front);
  EXPECT_LT(*std::min_element(behind.range_m.begin(), behind.range_m.end()), 50.0);
  EXPECT_EQ(in_front.range_m, std::vector<double>(kRays * kRays, 20.0));
}

TEST(SceneEffects, PlumeReturnsItsShareOfTheRaysUniformlyAroundTheTarget) {
  const double radius_m = 1.5 * kSwath_m / 2.1;
  RangeGrid grid = empty_grid();
  EffectRandom random = random_of(1);
  add_plume(0.05, kFlash, random, grid);
  double sum_m = 0.0, squares = 0.0;
  int middle = 0;
  for (int i = 0; i < kRays * kRays; ++i) {
    if (!std::isfinite(grid.range_m[i])) continue;
    const double x = grid.slope(i % kRays), y = grid.slope(i / kRays);
    const Eigen::Vector3d place =
        grid.range_m[i] * Eigen::Vector3d(x, 1.0, -y).normalized() - Eigen::Vector3d(0, kRange_m, 0);
    EXPECT_LE(place.norm(), radius_m + 1e-9);
    if (std::hypot(x, y) > 0.3 * grid.tan_half_fov) continue;
    sum_m += place.y();
    squares += place.y() * place.y();
    ++middle;
  }
  // The corners of the view lie outside the sphere by a little.
  EXPECT_NEAR(returns(grid), 0.05 * kRays * kRays, 170.0);
  ASSERT_GT(middle, 30);
  EXPECT_NEAR(sum_m / middle, 0.0, 6.0 * radius_m / std::sqrt(3.0 * middle));
  EXPECT_NEAR(squares / middle, radius_m * radius_m / 3.0,
              3.0 * radius_m * radius_m / std::sqrt(10.0 * middle));
}

TEST(SceneEffects, PlumeIsNewInEveryFrameAndOnlyNearTheTarget) {
  RangeGrid first = empty_grid(0.2), second = empty_grid(0.2);
  EffectRandom one = random_of(1), two = random_of(2);
  add_plume(0.5, kFlash, one, first);
  add_plume(0.5, kFlash, two, second);
  EXPECT_NE(first.range_m, second.range_m);
  // Seen through the disc of the sphere.
  const double radius_rays = std::tan(std::asin(1.5 * kSwath_m / 2.1 / kRange_m)) / (2.0 * 0.2) * kRays;
  EXPECT_NEAR(returns(first), 0.5 * kPi * radius_rays * radius_rays, 300.0);
}

}  // namespace
}  // namespace tumblesight::sim
