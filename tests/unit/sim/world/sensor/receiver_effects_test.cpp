// Verifies TS-SIL-300. The effects of the receiver against their closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/sensor/frame_truth.hpp"
#include "sim/world/sensor/ray_effects.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kRays = 128;
constexpr double kCount = kRays * kRays;
constexpr double kReturn_m = 40.0;
constexpr double kNone = std::numeric_limits<double>::infinity();

const FrameTruth kTruth{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), kReturn_m};
const std::array<Eigen::Vector3f, 6> kCorners{};
const Flash kFlash{kTruth, 6.0, kCorners};

// Returns in all rows but the first.
RangeGrid grid_of_returns() {
  RangeGrid grid;
  grid.rays = kRays;
  grid.tan_half_fov = 0.1;
  grid.range_m.assign(kRays * kRays, kReturn_m);
  std::fill_n(grid.range_m.begin(), kRays, kNone);
  return grid;
}

const SensorSettings kPaperSettings{};
static_assert(SensorSettings{}.rays == kRays);

EffectRandom random_of(std::uint64_t frame, std::uint64_t sequence = 7) {
  return {Random(frame), Random(sequence)};
}

double share(double count) {
  return count / kCount;
}

// Six standard deviations of a share.
double tolerance(double share) {
  return 6.0 * std::sqrt(share * (1.0 - share) / kCount);
}

TEST(ReceiverEffects, BiasScaleAndWalkChangeReturnsAlone) {
  RangeGrid grid = grid_of_returns();
  grid.surfaces.assign(grid.range_m.size(), {kReturn_m, 0.25, false});
  EffectRandom random = random_of(1);
  add_range_walk(0.8, kFlash, random, grid);
  EXPECT_NEAR(grid.range_m.back(), 40.6, 1e-9);
  scale_ranges(0.01, kFlash, random, grid);
  EXPECT_NEAR(grid.range_m.back(), 41.006, 1e-9);
  add_range_bias(-0.5, kFlash, random, grid);
  EXPECT_NEAR(grid.range_m.back(), 40.506, 1e-9);
  EXPECT_EQ(grid.range_m.front(), kNone);
}

TEST(ReceiverEffects, FixedPatternIsGaussianAndTheSameInEveryFrame) {
  RangeGrid first = grid_of_returns(), second = grid_of_returns(), other = grid_of_returns();
  EffectRandom one = random_of(1), two = random_of(2), another_sensor = random_of(1, 8);
  add_fixed_pattern(0.2, kFlash, one, first);
  add_fixed_pattern(0.2, kFlash, two, second);
  add_fixed_pattern(0.2, kFlash, another_sensor, other);
  EXPECT_EQ(first.range_m, second.range_m);
  EXPECT_NE(first.range_m, other.range_m);
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const double range_m : first.range_m) {
    if (!std::isfinite(range_m)) continue;
    sum += range_m - kReturn_m;
    squares += (range_m - kReturn_m) * (range_m - kReturn_m);
    ++count;
  }
  EXPECT_EQ(count, kCount - kRays);
  EXPECT_NEAR(sum / count, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / count), 0.2, 0.01);
}

TEST(ReceiverEffects, FalseReturnsAreUniformOverTheGateAndNewInEveryFrame) {
  std::vector<double> first(kRays * kRays, kNoReturn_m), second = first;
  std::fill_n(first.begin(), kRays * kRays / 2, kReturn_m);
  const std::vector<double> before = first;
  EffectRandom one = random_of(1), two = random_of(2);
  add_false_returns(0.1, kPaperSettings, one, first);
  add_false_returns(0.1, kPaperSettings, two, second);
  double sum = 0.0, squares = 0.0, count = 0.0, on_returns = 0.0, in_both = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] == before[i]) continue;
    EXPECT_GT(first[i], 0.0);
    EXPECT_LT(first[i], 500.0);
    ++count;
    on_returns += before[i] > 0.0 ? 1.0 : 0.0;
    in_both += second[i] > 0.0 ? 1.0 : 0.0;
    sum += first[i];
    squares += first[i] * first[i];
  }
  EXPECT_NEAR(share(count), 0.1, tolerance(0.1));
  EXPECT_NEAR(on_returns / count, 0.5, 0.08);  // rays with and without a return alike
  EXPECT_NEAR(in_both / count, 0.1, 0.05);
  EXPECT_NEAR(sum / count, 250.0, 6.0 * 144.0 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 500.0 * 500.0 / 3.0, 10'000.0);
}

TEST(ReceiverEffects, HotPixelsStayAndReportTheFirstDarkCount) {
  std::vector<double> first(kRays * kRays, kNoReturn_m), second = first;
  EffectRandom one = random_of(1), two = random_of(2);
  add_hot_pixels(0.05, kPaperSettings, one, first);
  add_hot_pixels(0.05, kPaperSettings, two, second);
  EXPECT_NE(first, second);
  double hot = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i] > 0.0, second[i] > 0.0) << i;
    hot += first[i] > 0.0 ? 1.0 : 0.0;
    sum += first[i];
  }
  EXPECT_NEAR(share(hot), 0.05, tolerance(0.05));
  EXPECT_NEAR(sum / hot, 100.0, 6.0 * 100.0 / std::sqrt(hot));
}

// The first of an exponential count with a mean of 100 m and of the return at 40 m.
TEST(ReceiverEffects, HotPixelsReportANearerReturn) {
  std::vector<double> ranges_m(kRays * kRays, kReturn_m);
  EffectRandom random = random_of(1);
  add_hot_pixels(0.5, kPaperSettings, random, ranges_m);
  double nearer = 0.0;
  for (const double range_m : ranges_m) {
    EXPECT_LE(range_m, kReturn_m);
    nearer += range_m < kReturn_m ? 1.0 : 0.0;
  }
  const double expected = 0.5 * (1.0 - std::exp(-kReturn_m / 100.0));
  EXPECT_NEAR(share(nearer), expected, tolerance(expected));
}

TEST(ReceiverEffects, DeadPixelsAndLinesReportNothing) {
  std::vector<double> pixels(kRays * kRays, kReturn_m), lines = pixels;
  EffectRandom one = random_of(1), two = random_of(1);
  add_dead_pixels(0.2, kPaperSettings, one, pixels);
  const auto dead = [](const std::vector<double>& range_m) {
    double count = 0.0;
    for (const double r : range_m) count += r == kNoReturn_m ? 1.0 : 0.0;
    return count;
  };
  EXPECT_NEAR(share(dead(pixels)), 0.2, tolerance(0.2));
  add_dead_lines(0.1, kPaperSettings, two, lines);
  int rows = 0, columns = 0;
  for (int i = 0; i < kRays; ++i) {
    bool row = true, column = true;
    for (int j = 0; j < kRays; ++j) {
      row = row && lines[i * kRays + j] == kNoReturn_m;
      column = column && lines[j * kRays + i] == kNoReturn_m;
    }
    rows += row;
    columns += column;
  }
  EXPECT_NEAR(rows, 12.8, 14.0);
  EXPECT_NEAR(columns, 12.8, 14.0);
  EXPECT_GT(rows + columns, 8);
  EXPECT_EQ(dead(lines), rows * kRays + columns * kRays - rows * columns);
}

}  // namespace
}  // namespace tumblesight::sim
