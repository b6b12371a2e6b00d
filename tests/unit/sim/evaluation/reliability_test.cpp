#include "sim/evaluation/reliability.hpp"

#include <gtest/gtest.h>

#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

FrameResult predicted(double predicted_deg, double real_deg) {
  FrameResult made = result_with(0, 0, real_deg, 0.0);
  made.rcnn_predicted_rad = predicted_deg * kRadPerDeg;
  return made;
}

TEST(Reliability, DividesByThePredictedErrorIntoTenthsOfEqualCount) {
  std::vector<FrameResult> results;
  for (int i = 99; i >= 0; --i) results.push_back(predicted(0.5 * i, i));
  const std::vector<ReliabilityBin> bins = reliability(results);
  ASSERT_EQ(bins.size(), kReliabilityBins);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_EQ(bins[i].real.count, 10U);
    EXPECT_NEAR(bins[i].real.mean_deg, 10.0 * static_cast<double>(i) + 4.5, 1e-9);
    EXPECT_NEAR(bins[i].predicted_deg, 0.5 * bins[i].real.mean_deg, 1e-9);
  }
}

TEST(Reliability, LeavesOutFramesWithoutEstimate) {
  EXPECT_TRUE(reliability({FrameResult{}}).empty());
  EXPECT_EQ(reliability({predicted(1.0, 2.0), FrameResult{}}).size(), 1U);
}

TEST(Detection, CountsWhatAThresholdRejects) {
  const std::vector<DetectionPoint> points =
      detection({predicted(25.0, 90.0), predicted(4.0, 100.0), predicted(6.0, 3.0), predicted(1.5, 2.0)});
  for (const DetectionPoint& point : points) {
    EXPECT_EQ(point.wrong, 2U);
    EXPECT_EQ(point.right, 2U);
    if (point.threshold_deg != 5.0) continue;
    EXPECT_DOUBLE_EQ(point.detected(), 0.5);
    EXPECT_DOUBLE_EQ(point.false_alarms(), 0.5);
    EXPECT_DOUBLE_EQ(point.wrong_among_kept(), 0.5);
  }
  EXPECT_EQ(points.front().wrong_flagged, 2U);  // above 1 degree: all of them
  EXPECT_EQ(points.back().wrong_flagged, 0U);
}

TEST(Detection, AddsUpOverConditions) {
  std::vector<DetectionPoint> sum;
  add(sum, detection({predicted(50.0, 90.0)}));
  add(sum, detection({predicted(2.0, 90.0), predicted(2.0, 1.0)}));
  EXPECT_EQ(sum.back().wrong, 2U);
  EXPECT_EQ(sum.back().right, 1U);
  EXPECT_DOUBLE_EQ(sum.back().false_alarms(), 0.0);
}

}  // namespace
}  // namespace tumblesight::sim
