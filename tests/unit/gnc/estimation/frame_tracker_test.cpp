// Verifies TS-FDIR-070 and TS-FDIR-170.
#include "gnc/estimation/frame_tracker.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "tests/support/test_models.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int64_t kStart_ns = 1'000'000'000'000;
constexpr FrameTrackerLimits kTrackerLimits{
    {1'000'000, 2'970'000'000}, 21'600'000'000, 8'100'000'000, 10'000'000, kPi_urad, kPi_urad};

QuaternionQ30 q30(const Eigen::Quaterniond& q) {
  const auto part = [](double x) { return static_cast<std::int32_t>(std::lround(std::ldexp(x, 30))); };
  return {part(q.w()), part(q.x()), part(q.y()), part(q.z())};
}

class Tracking : public ::testing::Test {
 protected:
  Tracking() {
    const auto& image = lasting_model_image<FixedPoint>(7);
    EXPECT_EQ(estimator->load(image.data(), image.size(), nullptr), ModelStatus::kOk);
  }
  RangeImage next(std::int64_t elapsed_ns = kNominalPeriod_ns) {
    RangeImage frame = random_frame(++number);
    frame.sequence_number = number;
    frame.exposure_time_ns = now_ns += elapsed_ns;
    return frame;
  }
  const FrameOutcome& step(const RangeImage& frame, const ChaserAttitude& chaser,
                           const ChaserAttitude& chaser_now) {
    outcome = {};
    FrameTracker<FixedPoint>(*estimator).step({frame, chaser, chaser_now, now_ns}, limits, state, outcome);
    return outcome;
  }
  const FrameOutcome& step(const RangeImage& frame, const ChaserAttitude& chaser = {}) {
    return step(frame, chaser, chaser);
  }
  ChaserAttitude chaser(const Eigen::Quaterniond& q) const { return {now_ns, q30(q), true}; }

  std::unique_ptr<AttitudeEstimator<FixedPoint>> estimator =
      std::make_unique<AttitudeEstimator<FixedPoint>>();
  FrameTrackerLimits limits = kTrackerLimits;
  FrameTrackerState state;
  FrameOutcome outcome;
  std::int64_t now_ns = kStart_ns;
  std::uint32_t number = 0;
};

TEST_F(Tracking, OnePeriodWithoutATurnGivesTheBitsOfTheEstimatorAlone) {
  const auto alone = std::make_unique<AttitudeEstimator<FixedPoint>>();
  const auto& image = lasting_model_image<FixedPoint>(7);
  ASSERT_EQ(alone->load(image.data(), image.size(), nullptr), ModelStatus::kOk);
  for (int i = 0; i < 10; ++i) {
    const bool turning = i >= 5;
    if (i == 5) alone->reset();
    const RangeImage frame = next();
    AttitudeEstimate estimate;
    ASSERT_EQ(alone->step(frame, estimate), FrameStatus::kOk);
    ASSERT_TRUE(step(frame, turning ? ChaserAttitude{now_ns, kIdentityQ30, true} : ChaserAttitude{}).used());
    EXPECT_EQ(outcome.estimate.q_lrf_trf, estimate.q_lrf_trf);
    EXPECT_EQ(estimator->state_crc32(), alone->state_crc32());
  }
}

TEST_F(Tracking, RefusedFrameChangesNothing) {
  step(next());
  step(next());
  const std::uint32_t crc = estimator->state_crc32();
  RangeImage frame = next(100 * kNominalPeriod_ns);
  frame.ranges.fill(0);
  EXPECT_EQ(step(frame).verdict, FrameVerdict::kBadContent);
  EXPECT_EQ(outcome.content, FrameStatus::kEmpty);
  frame = next();
  frame.exposure_time_ns += 2'000'000;
  EXPECT_EQ(step(frame).verdict, FrameVerdict::kFromFuture);
  EXPECT_FALSE(outcome.valid());
  EXPECT_EQ(estimator->state_crc32(), crc);
  EXPECT_EQ(estimator->frames(), 2U);
  EXPECT_EQ(state.gate.last_sequence_number(), 2U);
}

TEST_F(Tracking, RepeatedRangesAreRefusedUntilTheyChange) {
  RangeImage frame = next();
  step(frame);
  const std::uint32_t crc = estimator->state_crc32();
  for (int i = 0; i < 4; ++i) {
    frame.sequence_number = ++number;
    frame.exposure_time_ns = now_ns += (i + 1) * kNominalPeriod_ns;
    EXPECT_EQ(step(frame).verdict, FrameVerdict::kRepeated);
    EXPECT_EQ(estimator->state_crc32(), crc);
    if (i == 1) state.forget_times();
    if (i == 2) state.forget_track();
  }
  frame.ranges[frame.rays * (frame.rays / 2) + frame.rays / 2] += 1;
  EXPECT_EQ(step(frame).verdict, FrameVerdict::kRepeated) << "one range alone";
  frame.ranges = next().ranges;
  frame.exposure_time_ns = now_ns;
  frame.sequence_number = ++number;
  EXPECT_TRUE(step(frame).used());
}

TEST_F(Tracking, GivesUpAfterTheLongestCoastOnly) {
  step(next());
  step(next(limits.longest_coast_ns));
  EXPECT_EQ(outcome.estimate.frames_since_reset, 2U);
  EXPECT_EQ(outcome.frames_given_up, 0U);
  step(next(limits.longest_coast_ns + 1));
  EXPECT_EQ(outcome.estimate.frames_since_reset, 1U);
  EXPECT_EQ(outcome.frames_given_up, 2U);
}

TEST_F(Tracking, AJumpIsADistanceFromThePrediction) {
  limits.attitude_jump_urad = 87'266;
  limits.predicted_error_urad = kPi_urad;
  bool jumped_before = false;
  int jumps = 0;
  for (int i = 0; i < 20; ++i) {
    step(next(1'000'000'000 + std::int64_t{700'000'000} * (i % 5)));
    ASSERT_EQ(static_cast<int>(outcome.verdict), 0) << i;
    const double cosine =
        std::abs(to_double(outcome.estimate.q_lrf_trf_predicted).dot(to_double(outcome.estimate.q_lrf_trf)));
    const bool jumps_now = i >= 2 && 2 * std::acos(std::min(1.0, cosine)) > 87'266e-6;
    EXPECT_EQ((outcome.doubts & kAttitudeJump) != 0, jumps_now || jumped_before)
        << i << ' ' << outcome.doubts;
    EXPECT_EQ(outcome.valid(), !(jumps_now || jumped_before)) << i << ' ' << outcome.doubts;
    jumped_before = jumps_now;
    jumps += jumps_now ? 1 : 0;
  }
  EXPECT_GT(jumps, 0) << "the test needs a network that jumps";
}

// Verifies TS-EST-190.
TEST_F(Tracking, AFrameThatTheTargetDoesNotExplainIsADoubt) {
  EXPECT_FALSE(step(next()).estimate.explained.is_known) << "the image has no surface";
  EXPECT_TRUE(outcome.valid());
  // At the limit, and beyond it.
  for (const std::uint32_t more : {0U, 1U}) {
    outcome.doubts = 0;
    outcome.estimate.explained = {true, kLargestMisfit + more, 0, 0};
    check_attitude(limits, state, outcome);
    EXPECT_EQ(outcome.doubts, more == 0 ? 0 : kUnexplained);
    EXPECT_EQ(outcome.valid(), more == 0);
  }
  // A target of one point explains none of the returns.
  const auto& without = lasting_model_image<FixedPoint>(7);
  ModelHeader header;
  const auto weights = std::make_unique<NetworkWeights<FixedPoint>>();
  ASSERT_EQ(read_model_image<FixedPoint>(without.data(), without.size(), nullptr, header, *weights),
            ModelStatus::kOk);
  std::vector<std::uint8_t> surface(SurfaceModel::kBytes), image(without.size());
  surface[0] = 1;
  ASSERT_EQ(write_model_image<FixedPoint>(header, *weights, image.data(), image.size(), {surface.data()}),
            image.size());
  ASSERT_EQ(estimator->load(image.data(), image.size(), nullptr), ModelStatus::kOk);
  const std::uint32_t constants = estimator->constants_crc32();
  EXPECT_TRUE(step(next()).estimate.explained.is_known);
  EXPECT_EQ(outcome.estimate.explained.outliers, kWholeShare);
  EXPECT_EQ(outcome.doubts & kUnexplained, kUnexplained);
  EXPECT_FALSE(outcome.valid());
  estimator->reload(image.data());
  EXPECT_EQ(estimator->constants_crc32(), constants);
}

// Verifies TS-EST-184.
TEST_F(Tracking, PredictionTurnsWithTheChaser) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  RangeImage frame = next();
  step(frame, chaser(Eigen::Quaterniond::Identity()));
  EXPECT_EQ(outcome.doubts & kChaserUnknown, 0U);
  const Eigen::Quaterniond first = to_double(outcome.estimate.q_lrf_trf);
  // The LRF turns by `turn`: a target at rest turns the other way in it.
  frame = next();
  const ChaserAttitude later{now_ns, q30(turn * turn), true};
  step(frame, chaser(turn), later);
  EXPECT_EQ(outcome.doubts & (kChaserUnknown | kChaserNowUnknown), 0U);
  EXPECT_NEAR(std::abs(to_double(outcome.estimate.q_lrf_trf_predicted).dot(turn.conjugate() * first)), 1.0,
              1e-6);
  const Eigen::Quaterniond second = to_double(outcome.estimate.q_lrf_trf);
  EXPECT_NEAR(std::abs(to_double(outcome.motion_now.q_lrf_trf).dot(turn.conjugate() * second)), 1.0, 1e-6);
}

// Verifies TS-EST-184.
TEST_F(Tracking, TheChasersAttitudeHoldsForAWholeTrackOrForNone) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  for (int i = 0; i < 3; ++i) {
    const RangeImage frame = next();
    step(frame, chaser(turn));
  }
  const std::uint32_t crc = estimator->state_crc32();
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(step(next()).verdict, FrameVerdict::kWithoutChaser);
    EXPECT_EQ(estimator->state_crc32(), crc);
    EXPECT_EQ(state.gate.last_sequence_number(), 3U);
  }
  EXPECT_TRUE(step(next()).used()) << "more than three periods after the last used frame";
  EXPECT_EQ(outcome.estimate.frames_since_reset, 1U);
  EXPECT_EQ(outcome.frames_given_up, 3U);
  EXPECT_TRUE(outcome.chaser_changed);
  EXPECT_EQ(outcome.doubts & kChaserUnknown, kChaserUnknown);
  RangeImage frame = next();
  step(frame, {}, chaser(turn));
  EXPECT_EQ(outcome.estimate.frames_since_reset, 2U);
  EXPECT_FALSE(outcome.chaser_changed);
  EXPECT_EQ(outcome.doubts & kChaserUnknown, kChaserUnknown);
  // The LRF is taken not to turn, also to the time of the cycle.
  EXPECT_EQ(outcome.motion_now.q_lrf_trf, outcome.estimate.q_lrf_trf);
  EXPECT_EQ(outcome.doubts & kChaserNowUnknown, kChaserNowUnknown);
  frame = next();
  step(frame, chaser(turn), {});
  EXPECT_EQ(outcome.estimate.frames_since_reset, 1U);
  EXPECT_EQ(outcome.frames_given_up, 2U);
  EXPECT_TRUE(outcome.chaser_changed);
  EXPECT_EQ(outcome.doubts & kChaserUnknown, 0U);
  EXPECT_EQ(outcome.motion_now.q_lrf_trf, outcome.estimate.q_lrf_trf);
  EXPECT_EQ(outcome.doubts & kChaserNowUnknown, kChaserNowUnknown);
}

// Verifies TS-EST-184.
TEST_F(Tracking, AfterAShortLossOfTheChasersAttitudeTheTrackTurnsByAllOfIt) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()));
  RangeImage frame = next();
  step(frame, chaser(Eigen::Quaterniond::Identity()));
  const Eigen::Quaterniond first = to_double(outcome.estimate.q_lrf_trf);
  step(next());
  frame = next();
  step(frame, chaser(turn * turn));
  EXPECT_EQ(outcome.estimate.frames_since_reset, 2U);
  EXPECT_EQ(outcome.doubts & kChaserUnknown, 0U);
  EXPECT_NEAR(
      std::abs(to_double(outcome.estimate.q_lrf_trf_predicted).dot((turn * turn).conjugate() * first)), 1.0,
      1e-6);
}

// Verifies TS-EST-184.
TEST_F(Tracking, AfterAGapTheGapIsTheReason) {
  RangeImage frame = next();
  step(frame, chaser(Eigen::Quaterniond::Identity()));
  step(next(limits.longest_coast_ns + 1));
  EXPECT_EQ(outcome.frames_given_up, 1U);
  EXPECT_FALSE(outcome.chaser_changed);
}

// Verifies TS-EST-184.
TEST_F(Tracking, AfterAResetNoAttitudeOfTheChaserIsNeeded) {
  const RangeImage frame = next();
  step(frame, chaser(Eigen::Quaterniond::Identity()));
  estimator->reset();
  state.forget_track();
  EXPECT_TRUE(step(next()).used());
  EXPECT_EQ(outcome.frames_given_up, 0U);
}

TEST_F(Tracking, FramesThatAlternateAreRefused) {
  std::array<RangeImage, FrameHistory::kFrames + 1> used;
  for (RangeImage& frame : used) EXPECT_TRUE(step(frame = next()).used());
  for (int round = 0; round < 2; ++round) {
    for (std::size_t which = 1; which < used.size(); ++which) {
      RangeImage frame = next();
      frame.ranges = used[which].ranges;
      EXPECT_EQ(step(frame).verdict, FrameVerdict::kRepeated) << which;
    }
  }
  RangeImage frame = next();
  frame.ranges = used[0].ranges;
  EXPECT_TRUE(step(frame).used()) << "only eight are kept";
}

// Verifies TS-EST-182.
TEST_F(Tracking, FramesTooFarApartForTheRateAreNoJumps) {
  limits.attitude_jump_urad = 1;
  for (int i = 0; i < 12; ++i) {
    step(next(kLongestToFindRate_ns + 1));
    EXPECT_TRUE(outcome.valid()) << i;
    EXPECT_EQ(outcome.doubts & kRateAmbiguous, i > 0 ? kRateAmbiguous : 0) << i;
    EXPECT_EQ(outcome.frames_given_up, 0U);
  }
  // As soon as two frames are close enough, the rate is found, and the track can coast with it.
  step(next(kLongestToFindRate_ns));
  EXPECT_EQ(outcome.doubts & kRateAmbiguous, 0U);
  EXPECT_EQ(outcome.estimate.frames_since_reset, 2U);
  step(next(kLongestToFindRate_ns + 1));
  EXPECT_EQ(outcome.estimate.frames_since_reset, 3U);
  EXPECT_NE(outcome.doubts & kAttitudeJump, 0U);
  // A new track has to find it anew.
  estimator->reset();
  state.forget_track();
  step(next(kLongestToFindRate_ns + 1));
  EXPECT_EQ(outcome.doubts & kRateAmbiguous, 0U) << "the first frame";
  step(next(kLongestToFindRate_ns + 1));
  EXPECT_NE(outcome.doubts & kRateAmbiguous, 0U);
}

// Verifies TS-EST-182.
TEST_F(Tracking, TrackThatIsGivenUpTellsTheNextOneNothingOfItsRate) {
  step(next());
  step(next());
  EXPECT_TRUE(state.has_found_rate);
  step(next(limits.longest_coast_ns + 1));
  EXPECT_EQ(outcome.frames_given_up, 2U);
  EXPECT_FALSE(outcome.finds_no_rate) << "the first frame of a track has none to find";
  step(next(kLongestToFindRate_ns + 1));
  EXPECT_TRUE(outcome.finds_no_rate) << "the rate of the track before is not that of this one";
  EXPECT_NE(outcome.doubts & kRateAmbiguous, 0U);
  step(next(limits.longest_coast_ns + 1));
  EXPECT_GT(outcome.frames_given_up, 0U);
  EXPECT_FALSE(outcome.finds_no_rate) << "the first frame";
}

TEST_F(Tracking, ALimitOfAHalfTurnDetectsNoJump) {
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(step(next()).valid());
}

TEST_F(Tracking, AJumpIsADoubtForOneMoreFrame) {
  for (int i = 0; i < 3; ++i) step(next());
  state.has_jumped = true;
  EXPECT_EQ(step(next()).doubts & kAttitudeJump, kAttitudeJump);
  EXPECT_EQ(step(next()).doubts & kAttitudeJump, 0U);
  state.has_jumped = true;
  state.forget_track();
  EXPECT_TRUE(step(next()).valid());
}

TEST(TurnOfLrf, TakesTheLastLrfToTheOneNow) {
  const Eigen::Quaterniond last(Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 2) / 3));
  const Eigen::Quaterniond now(Eigen::AngleAxisd(-0.4, Eigen::Vector3d(2, -1, 2) / 3));
  const Eigen::Vector3d v(1, 2, 3);
  EXPECT_TRUE((to_double(turn_of_lrf(q30(last), q30(now))) * v).isApprox(now.conjugate() * (last * v), 1e-7));
}

}  // namespace
}  // namespace tumblesight::gnc
