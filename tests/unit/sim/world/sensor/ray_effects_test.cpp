#include "sim/world/sensor/ray_effects.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tumblesight::sim {
namespace {

constexpr double kMiss = std::numeric_limits<double>::infinity();
constexpr double kReturn_m = 32.0;

// Two rays that hit and two that do not, in turn.
RangeGrid hits_and_misses() {
  RangeGrid grid;
  grid.rays = 2;
  grid.tan_half_fov = 0.1;
  grid.range_m = {kReturn_m, kMiss, kReturn_m, kMiss};
  return grid;
}

std::vector<double> measured_m(const std::vector<RayEffect>& effects, const SensorSettings& settings = {}) {
  gnc::RangeImage frame{};
  report_ranges(measured_ranges_m(hits_and_misses(), effects, settings, 1), settings, 200'000, frame);
  std::vector<double> ranges_m;
  for (int ray = 0; ray < 4; ++ray)
    ranges_m.push_back(frame.ranges[ray] * double{gnc::RangeImage::kMetresPerCount});
  return ranges_m;
}

AfterEffect add_one_metre(const SensorSettings&, Random&, double& range_m) {
  range_m += 1.0;
  return AfterEffect::kContinue;
}

AfterEffect lose(const SensorSettings&, Random&, double& range_m) {
  range_m = kNoReturn_m;
  return AfterEffect::kContinue;
}

AfterEffect end_at_two_metres(const SensorSettings&, Random&, double& range_m) {
  range_m = 2.0;
  return AfterEffect::kFinal;
}

using Ranges = std::vector<double>;

TEST(RayEffects, ActOnTheRaysThatTheirRowNames) {
  EXPECT_EQ(measured_m({}), (Ranges{32, 0, 32, 0}));
  EXPECT_EQ(measured_m({{add_one_metre, ActsOn::kHits}}), (Ranges{33, 0, 33, 0}));
  EXPECT_EQ(measured_m({{add_one_metre, ActsOn::kMisses}}), (Ranges{32, 1, 32, 1}));
  EXPECT_EQ(measured_m({{add_one_metre, ActsOn::kAll}}), (Ranges{33, 1, 33, 1}));
}

TEST(RayEffects, ApplyInTheirOrderUntilOneIsFinal) {
  EXPECT_EQ(measured_m({{end_at_two_metres, ActsOn::kMisses}, {add_one_metre, ActsOn::kAll}}),
            (Ranges{33, 2, 33, 2}));
  EXPECT_EQ(measured_m({{add_one_metre, ActsOn::kAll}, {end_at_two_metres, ActsOn::kMisses}}),
            (Ranges{33, 2, 33, 2}));
}

TEST(RayEffects, ARayWhoseReturnIsLostIsStillAHit) {
  EXPECT_EQ(measured_m({{lose, ActsOn::kHits}, {add_one_metre, ActsOn::kMisses}}), (Ranges{0, 1, 0, 1}));
  EXPECT_EQ(measured_m({{add_one_metre, ActsOn::kMisses}, {lose, ActsOn::kHits}}), (Ranges{0, 1, 0, 1}));
}

TEST(RayEffects, OfTheSensorMakeNoReturnsWhereNothingIsHit) {
  SensorSettings harsh;
  harsh.outlier_share = 0.9;
  for (const SensorSettings& settings : {SensorSettings{}, harsh}) {
    const Ranges ranges_m = measured_m(ray_effects(), settings);
    EXPECT_GT(ranges_m[0], 0.0);
    EXPECT_EQ(ranges_m[1], 0.0);
    EXPECT_GT(ranges_m[2], 0.0);
    EXPECT_EQ(ranges_m[3], 0.0);
  }
}

}  // namespace
}  // namespace tumblesight::sim
