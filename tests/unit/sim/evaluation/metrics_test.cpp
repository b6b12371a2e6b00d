#include "sim/evaluation/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

Eigen::Quaterniond negated(const Eigen::Quaterniond& q) {
  return {-q.w(), -q.x(), -q.y(), -q.z()};
}

TEST(AngularError, IsTheAngleOfTheRotationBetweenTwoAttitudes) {
  const Eigen::Quaterniond attitude = turned(123.0, {0.2, 1.0, -0.7});
  for (const double angle_deg : {0.0, 1e-7, 0.01, 5.0, 20.0, 90.0, 179.0, 180.0}) {
    const Eigen::Quaterniond other = turned(angle_deg, {1.0, 2.0, 3.0}) * attitude;
    EXPECT_NEAR(angular_error_rad(attitude, other) / kRadPerDeg, angle_deg, 1e-11 + 1e-9 * angle_deg);
  }
}

TEST(AngularError, DoesNotDependOnTheSignOfAQuaternion) {
  const Eigen::Quaterniond a = turned(10.0, {1.0, 0.0, 0.0});
  const Eigen::Quaterniond b = turned(50.0, {1.0, 0.0, 0.0});
  EXPECT_NEAR(angular_error_rad(a, negated(b)), 40.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(angular_error_rad(negated(a), b), 40.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(angular_error_rad(a, negated(a)), 0.0, 1e-12);
}

TEST(AngularError, AgreesWithThePapersFormula) {
  const Eigen::Quaterniond a = turned(33.0, {1.0, 0.5, 0.0});
  const Eigen::Quaterniond b = turned(-71.0, {0.0, 0.5, 2.0});
  EXPECT_NEAR(angular_error_rad(a, b), 2.0 * std::acos(std::abs(a.dot(b))), 1e-9);
}

TEST(AngularError, StaysFiniteForQuaternionsOffUnitLength) {
  Eigen::Quaterniond a = turned(5.0, {0.0, 0.0, 1.0});
  Eigen::Quaterniond scaled = a;
  scaled.coeffs() *= 1.0 + 1e-6;
  EXPECT_NEAR(angular_error_rad(a, scaled), 0.0, 1e-7);
}

TEST(ErrorSummary, MatchesFiguresCalculatedByHand) {
  const ErrorSummary summary = summarise({30.0, 4.0, 5.0, 20.0, 1.0});
  EXPECT_EQ(summary.count, 5U);
  EXPECT_DOUBLE_EQ(summary.mean_deg, 12.0);
  EXPECT_DOUBLE_EQ(summary.median_deg, 5.0);
  EXPECT_DOUBLE_EQ(summary.within_20deg, 0.8);
  EXPECT_DOUBLE_EQ(summary.within_5deg, 0.6);
  EXPECT_DOUBLE_EQ(summary.mean_within_20_deg, 7.5);
  EXPECT_DOUBLE_EQ(summary.mean_within_20_standard_error_deg, std::sqrt(217.0 / 3.0 / 4.0));
  EXPECT_TRUE(std::isnan(summary.wrong_and_valid)) << "validity is not known";
}

TEST(ErrorSummary, HasNoMeanWithin20DegreesIfAllAreWrong) {
  EXPECT_TRUE(std::isnan(summarise({21.0, 90.0}).mean_within_20_deg));
}

TEST(LastFrame, SharesOfTrustedEstimatesCountRightAndWrongOnes) {
  std::vector<FrameResult> results{result_with(0, 0, 3.0, 40.0), result_with(1, 0, 30.0, 3.0),
                                   result_with(2, 0, 19.0, 3.0), result_with(3, 0, 25.0, 3.0),
                                   result_with(4, 0, 1.0, 3.0)};
  for (const std::size_t trusted : {0, 1, 4}) results[trusted].trusted = true;
  results.push_back(results.front());
  results.back().frame = 7;  // not a last frame
  const ErrorSummary rcnn = last_frame_summary(results, 1, Estimator::kRcnn);
  EXPECT_EQ(rcnn.count, 5U);
  EXPECT_DOUBLE_EQ(rcnn.right_and_valid, 0.4);
  EXPECT_DOUBLE_EQ(rcnn.wrong_and_valid, 0.2);
  const ErrorSummary cnn = last_frame_summary(results, 1, Estimator::kCnn);
  EXPECT_DOUBLE_EQ(cnn.right_and_valid, 0.4);
  EXPECT_DOUBLE_EQ(cnn.wrong_and_valid, 0.2);
  EXPECT_EQ(last_frame_summary({}, 1, Estimator::kRcnn).count, 0U);
}

TEST(LastFrame, ExpectedErrorsAreComparedWithRealOnesWhereThereIsAnEstimate) {
  std::vector<FrameResult> results{result_with(0, 0, 2.0, 40.0), result_with(1, 0, 4.0, 3.0),
                                   result_with(2, 0, 30.0, 3.0), result_with(3, 0, 1.0, 3.0)};
  const double expected_deg[] = {1.0, 1.0, 12.0, 5.0};
  for (std::size_t i = 0; i < 4; ++i) {
    results[i].rcnn_predicted_rad = kRadPerDeg * expected_deg[i];
    results[i].cnn_predicted_rad = kRadPerDeg * 7.0;
  }
  results[3].valid = false;
  const ErrorSummary rcnn = last_frame_summary(results, 1, Estimator::kRcnn);
  EXPECT_DOUBLE_EQ(rcnn.error_below_3_expected, 2.0 / 3.0);
  EXPECT_NEAR(rcnn.expected_over_real, 14.0 / 36.0, 1e-12);
  const ErrorSummary cnn = last_frame_summary(results, 1, Estimator::kCnn);
  EXPECT_DOUBLE_EQ(cnn.error_below_3_expected, 2.0 / 3.0);
  EXPECT_NEAR(cnn.expected_over_real, 21.0 / 46.0, 1e-12);
  for (FrameResult& result : results) result.valid = false;
  EXPECT_TRUE(std::isnan(last_frame_summary(results, 1, Estimator::kRcnn).error_below_3_expected));
}

TEST(ErrorSummary, MedianOfAnEvenCountIsTheMiddle) {
  EXPECT_DOUBLE_EQ(median({4.0, 1.0, 3.0, 100.0}), 3.5);
  EXPECT_DOUBLE_EQ(median({}), 0.0);
}

TEST(ErrorSummary, OfNoResultsIsZero) {
  EXPECT_EQ(summarise({}).count, 0U);
}

TEST(LastFrame, LeavesOutSequencesThatEndedEarly) {
  const std::vector<FrameResult> results{result_with(0, 0, 50.0, 90.0), result_with(0, 1, 3.0, 30.0),
                                         result_with(1, 0, 60.0, 2.0)};
  const std::vector<double> rcnn = last_frame_errors_deg(results, 2, Estimator::kRcnn);
  ASSERT_EQ(rcnn.size(), 1U);
  EXPECT_NEAR(rcnn[0], 3.0, 1e-9);
  EXPECT_NEAR(last_frame_errors_deg(results, 2, Estimator::kCnn)[0], 30.0, 1e-9);
}

TEST(LastFrame, CountsAMissingAttitudeAsTheWorstOne) {
  const std::vector<FrameResult> results{FrameResult{}};
  EXPECT_DOUBLE_EQ(last_frame_errors_deg(results, 1, Estimator::kRcnn)[0], 180.0);
}

// Results that are off by the given turns in the axes of the target, at different true attitudes.
std::vector<FrameResult> turned_results(const std::vector<Eigen::AngleAxisd>& turns) {
  std::vector<FrameResult> results(turns.size());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    results[i].valid = true;
    results[i].truth =
        Eigen::AngleAxisd(0.7 * static_cast<double>(i), Eigen::Vector3d(1.0, 2.0, -1.0).normalized());
    results[i].rcnn = results[i].truth * turns[i];
  }
  return results;
}

TEST(CommonTurn, IsThatOfAMeshWithOtherAxes) {
  const Eigen::AngleAxisd quarter(1.6, Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd other(2.0, Eigen::Vector3d::UnitY());
  std::vector<FrameResult> results = turned_results({other, quarter, quarter, quarter});
  results.push_back(FrameResult{});  // without an attitude
  results[2].rcnn.coeffs() *= -1.0;
  const CommonTurn common = common_turn(results, Estimator::kRcnn);
  EXPECT_DOUBLE_EQ(common.share, 0.6);
  EXPECT_NEAR(common.turn.angle(), 1.6, 1e-9);
  EXPECT_NEAR(common.turn.axis().x(), 1.0, 1e-9);
}

TEST(NeverTrusted, CountsTheSequencesWithoutATrustedFrameFromAFrameOn) {
  std::vector<FrameResult> results;
  for (std::uint32_t sequence = 0; sequence < 4; ++sequence)
    for (std::uint32_t frame = 0; frame < 6; ++frame)
      results.push_back(result_with(sequence, frame, 3.0, 3.0));
  results[6 * 1 + 3].trusted = true;  // before
  results[6 * 2 + 4].trusted = true;
  results[6 * 3 + 5].trusted = true;
  EXPECT_DOUBLE_EQ(share_never_trusted(results, 4), 0.5);
  EXPECT_DOUBLE_EQ(share_never_trusted(results, 0), 0.25);
  EXPECT_EQ(share_never_trusted({}, 4), 0.0);
}

TEST(CommonTurn, IsNoneOfNoResultsAndSmallOfGoodOnes) {
  EXPECT_EQ(common_turn({}, Estimator::kRcnn).share, 0.0);
  const Eigen::AngleAxisd none(0.0, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(common_turn(turned_results({none, none}), Estimator::kRcnn).turn.angle(), 0.0, 1e-9);
}

TEST(LastFrame, OfTheBaselineCountsOnlyWhereItWasRun) {
  std::vector<FrameResult> results{result_with(0, 0, 3.0, 3.0), result_with(1, 0, 3.0, 3.0),
                                   result_with(2, 0, 3.0, 3.0)};
  results[0].has_baseline = true;
  results[0].baseline_valid = true;
  results[0].baseline = turned(7.0, {0.0, 1.0, 0.0}) * results[0].truth;
  results[1].has_baseline = true;  // without an attitude
  const std::vector<double> errors = last_frame_errors_deg(results, 1, Estimator::kBaseline);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_NEAR(errors[0], 7.0, 1e-9);
  EXPECT_DOUBLE_EQ(errors[1], 180.0);
}

}  // namespace
}  // namespace tumblesight::sim
