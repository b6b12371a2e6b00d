#include "sim/evaluation/curves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/world/sensor/effects.hpp"
#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

FrameResult at_range(double range_m, double rcnn_deg) {
  FrameResult made = result_with(0, 9, rcnn_deg, 2.0 * rcnn_deg);
  made.range_m = range_m;
  return made;
}

TEST(ErrorsByRange, CoverTheRangesOfTheRun) {
  const Curve curve = errors_by_range({at_range(60.0, 1.0), at_range(499.0, 3.0)}, {60.0, 500.0});
  ASSERT_EQ(curve.size(), 8U);
  EXPECT_EQ(curve.front().at, 87.5);
  EXPECT_EQ(curve.front().rcnn.count, 1U);
  EXPECT_EQ(curve.back().rcnn.count, 1U);
}

TEST(ErrorsByFrame, KeepFramesApart) {
  const std::vector<FrameResult> results{result_with(0, 0, 40.0, 50.0), result_with(0, 1, 4.0, 60.0),
                                         result_with(1, 0, 20.0, 70.0)};
  const Curve by_frame = errors_by_frame(results, 3);
  ASSERT_EQ(by_frame.size(), 3U);
  EXPECT_EQ(by_frame[0].at, 1.0);
  EXPECT_NEAR(by_frame[0].rcnn.mean_deg, 30.0, 1e-9);
  EXPECT_NEAR(by_frame[0].cnn.mean_deg, 60.0, 1e-9);
  EXPECT_NEAR(by_frame[1].rcnn.mean_deg, 4.0, 1e-9);
  EXPECT_EQ(by_frame[2].rcnn.count, 0U);
}

// A frozen sensor owes no attitude, so the lack of one is no error.
TEST(ErrorsByFrame, LeaveOutWhatWasNeitherOwedNorGiven) {
  std::vector<FrameResult> results(4, result_with(0, 0, 4.0, 8.0));
  results[1].valid = false;  // owed: counts as 180 degrees
  results[2].owed = false;   // given nevertheless
  results[3].valid = false;
  results[3].owed = false;
  const Curve by_frame = errors_by_frame(results, 1);
  EXPECT_EQ(by_frame[0].rcnn.count, 3U);
  EXPECT_NEAR(by_frame[0].rcnn.mean_deg, (4.0 + 180.0 + 4.0) / 3.0, 1e-9);
}

TEST(Binned, GivesALowerEdgeToTheBinAboveItAndTheLastEdgeToTheLastBin) {
  const std::vector<FrameResult> results{at_range(20.0, 1.0), at_range(29.999, 3.0), at_range(30.0, 5.0),
                                         at_range(100.0, 7.0)};
  const Curve curve = errors_by_range(results);
  ASSERT_EQ(curve.size(), 8U);
  EXPECT_EQ(curve[0].at, 25.0);
  EXPECT_EQ(curve[0].rcnn.count, 2U);
  EXPECT_NEAR(curve[0].rcnn.mean_deg, 2.0, 1e-9);
  EXPECT_NEAR(curve[0].cnn.mean_deg, 4.0, 1e-9);
  EXPECT_NEAR(curve[1].rcnn.mean_deg, 5.0, 1e-9);
  EXPECT_EQ(curve[2].rcnn.count, 0U);
  EXPECT_NEAR(curve[7].rcnn.mean_deg, 7.0, 1e-9);
}

TEST(Binned, LeavesOutWhatLiesBeyondTheEdges) {
  const Curve curve = errors_by_range({at_range(19.9, 1.0), at_range(100.1, 1.0)});
  for (const CurvePoint& point : curve) EXPECT_EQ(point.rcnn.count, 0U);
}

TEST(ErrorsByRate, UsesTheNormInDegrees) {
  FrameResult made = result_with(0, 9, 6.0, 8.0);
  made.rate_rad_s = 18.0 * kRadPerDeg;
  const Curve curve = errors_by_rate({made});
  ASSERT_EQ(curve.size(), 8U);
  EXPECT_EQ(curve[7].at, 18.75);
  EXPECT_EQ(curve[7].rcnn.count, 1U);
}

TEST(Flatness, ComparesTheBinsThatHoldEnough) {
  Curve curve(3);
  curve[0].rcnn = summarise(std::vector<double>(40, 2.0));
  curve[1].rcnn = summarise(std::vector<double>(40, 3.0));
  curve[2].rcnn = summarise(std::vector<double>(5, 90.0));
  EXPECT_DOUBLE_EQ(flatness(curve), 1.5);
  EXPECT_DOUBLE_EQ(flatness(curve, 5), 45.0);
  EXPECT_EQ(flatness(curve, 41), 0.0);
}

TEST(Histogram, CountsALimitInTheBinBelowIt) {
  const std::vector<double> shares = histogram({0.0, 1.0, 1.5, 180.0});
  EXPECT_DOUBLE_EQ(shares.front(), 0.5);
  EXPECT_DOUBLE_EQ(shares[1], 0.25);
  EXPECT_DOUBLE_EQ(shares.back(), 0.25);
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-12);
}

// Verifies TS-SIL-170. Every effect, with a limit anywhere between its ends, whether it becomes harder
// upwards or downwards.
TEST(EffectLimits, LieOnBothSidesOfTheStrengthAtWhichTheShareFallsBelowTheBar) {
  for (const EffectRow& row : effect_table()) {
    if (row.lowest == row.highest) continue;
    for (const double place : {0.001, 0.3, 0.77, 0.999}) {
      for (const bool upwards : {true, false}) {
        const double wide = row.highest - std::max(0.0, row.lowest);
        const double edge = std::max(0.0, row.lowest) + place * wide;
        const auto share = [&](double strength) {
          EXPECT_TRUE(strength == 0.0 || !must_be_whole(row) || strength == std::round(strength)) << strength;
          return (std::abs(strength) <= edge) == upwards ? kEffectBar : kEffectBar - 1e-9;
        };
        const std::vector<EffectLimit> limits = effect_limits(row, share);
        ASSERT_EQ(limits.size(), row.lowest < 0.0 ? 2U : 1U) << row.name;
        for (const EffectLimit& limit : limits) {
          ASSERT_TRUE(limit.holds_at && limit.fails_at) << row.name << " " << place;
          const double holds = std::abs(*limit.holds_at), fails = std::abs(*limit.fails_at);
          EXPECT_EQ(holds <= edge, upwards) << row.name;
          EXPECT_NE(fails <= edge, upwards) << row.name;
          const double apart = std::abs(holds - fails);
          EXPECT_LE(apart, std::max(0.05 * std::max(holds, fails),
                                    std::max(0.01 * wide, double(must_be_whole(row)))))
              << row.name;
          EXPECT_LT(limit.trials.size(), 20U) << row.name;
        }
      }
    }
  }
}

TEST(EffectLimits, SayWhetherNoneOrBothEndsMeetTheBar) {
  const EffectRow& row = effect_named("noise");
  const EffectLimit none = effect_limits(row, [](double) { return 0.9; }).front();
  EXPECT_FALSE(none.holds_at);
  EXPECT_EQ(none.fails_at, row.lowest);
  const EffectLimit both = effect_limits(row, [](double) { return 0.95; }).front();
  EXPECT_EQ(both.holds_at, row.highest);
  EXPECT_FALSE(both.fails_at);
  EXPECT_EQ(both.trials.size(), 2U);
  const EffectLimit found = effect_limits(row, [](double x) { return x < 3.0 ? 1.0 : 0.0; }).front();
  for (const EffectLimit::Trial& trial : found.trials) {
    Effects effects;
    effects.noise = trial.strength;
    EXPECT_EQ(effects_from({to_string(effects)}).noise, trial.strength);
    EXPECT_LE(to_string(effects).size(), 12U) << to_string(effects);
  }
}

}  // namespace
}  // namespace tumblesight::sim
