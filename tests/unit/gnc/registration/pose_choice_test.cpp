// Which other attitudes a frame is compared with, and when the track is given up for one of them.
#include "tests/unit/gnc/registration/pose_alternatives.hpp"

namespace tumblesight::gnc {
namespace {

TEST_F(PoseAlternatives, ASecondAttitudeCountsFromOddsOfOnePercentOn) {
  see();
  const Eigen::Matrix3d right = truth_.r_lrf_trf;
  EXPECT_GT(error_deg(track({0.0, 3.0, 0.0}, right, 9'999)), 90.0);
  *state_ = {};
  EXPECT_LT(error_deg(track({0.0, 3.0, 0.0}, right, 10'000)), kLargestError_deg);
}

TEST_F(PoseAlternatives, ASecondAttitudeWithin20DegreesIsNone) {
  see();
  const Eigen::Matrix3d second = rotation_of({0.0, 19.0 * kDegree, 0.0}) * truth_.r_lrf_trf;
  track({0.0, 0.0, 0.0}, second, 1'000'000);
  EXPECT_EQ(state_->llr_q8, kWithoutAlternative_q8);
}

TEST_F(PoseAlternatives, FramesWithoutOneAddFourNatsEachUpTo32) {
  for (int k = 1; k < 10; ++k) {
    EXPECT_EQ(track_next().conservative_llr_q8, std::min(k * kWithoutAlternative_q8, kMostOfATrack_q8)) << k;
    EXPECT_EQ(state_->llr_q8, state_->conservative_llr_q8) << k;
  }
}

// Registered from eight degrees off it ends at the pose of the track.
TEST_F(PoseAlternatives, AnAttitudeThatLeadsToTheSamePoseIsNone) {
  track_frames(3);
  const std::int32_t before_q8 = state_->llr_q8;
  network_turn_ = Eigen::Vector3d(0.0, 0.0, 8.0 * kDegree);
  track_next();
  EXPECT_EQ(state_->llr_q8, before_q8 + kWithoutAlternative_q8);
}

// The network prefers the second attitude by four nats. The frame tells nothing, and the first stays, with
// less than nothing in favour of it.
TEST_F(PoseAlternatives, AFirstAttitudeThatIsSlightlyWorseStays) {
  take_box();
  see();
  const Eigen::Matrix3d second = rotation_of(half_turn()) * truth_.r_lrf_trf;
  const PoseEstimate estimate = track({0.01, 0.0, 0.01}, second, 1'000'000'000);
  EXPECT_LT(state_->llr_q8, 0);
  EXPECT_GE(state_->llr_q8, -6 * kNat_q8);
  EXPECT_LE(state_->conservative_llr_q8, state_->llr_q8);
  EXPECT_LT(error_deg(estimate), 2.0);
}

TEST_F(PoseAlternatives, ASecondAttitudeThatIsTakenHasTheAdvantage) {
  see();
  track({0.0, 3.0, 0.0}, truth_.r_lrf_trf, 500'000);
  EXPECT_GE(state_->llr_q8, 6 * kNat_q8);
}

// A body with a plate beside it that sends nothing back.
class DarkFirstFrame : public PoseAlternatives {
 protected:
  DarkFirstFrame() {
    Body body = lopsided_body();
    const Body bright = body;
    body.radius_m = 3.0;
    body.add_plate(1.7, 2.7, -0.8, 0.8, 0.0);
    take(body);
    shown_ = bright;
    truth_.r_lrf_trf = rotation_of({0.1, 0.2, 0.1});
    see();
  }
};

// Of the first three steps alone it would be 19 mrad.
constexpr std::uint32_t kSigmaOfAFullRegistration_urad = 13'000;

TEST_F(DarkFirstFrame, IsRegisteredFullyIfItIsExplained) {
  const PoseEstimate estimate = track({0.01, 0.02, -0.01}, truth_.r_lrf_trf, 0);
  ASSERT_GT(estimate.evidence.dark_surfaces, 0);
  ASSERT_TRUE(estimate.evidence.fits());
  EXPECT_LT(estimate.covariance.sigma[0], kSigmaOfAFullRegistration_urad);
  EXPECT_LT(error_deg(estimate), kLargestError_deg);
}

TEST_F(DarkFirstFrame, IsRegisteredFullyAtTheSecondAttitude) {
  const Eigen::Matrix3d second = rotation_of({0.01, 0.02, -0.01}) * truth_.r_lrf_trf;
  const PoseEstimate estimate = track({0.0, 3.0, 0.0}, second, 500'000);
  ASSERT_GT(estimate.evidence.dark_surfaces, 0);
  ASSERT_TRUE(estimate.evidence.fits());
  EXPECT_LT(estimate.covariance.sigma[0], kSigmaOfAFullRegistration_urad);
  EXPECT_LT(error_deg(estimate), kLargestError_deg);
}

// Returns beside the body contradict every pose. That of the search counts if it costs less.
TEST_F(DarkFirstFrame, ASearchAtTheSecondAttitudeNeverCostsMore) {
  for (int k = 0; k < 20; ++k) {
    *state_ = {};
    const Eigen::Matrix3d second = rotation_of(random_.vector(0.1)) * truth_.r_lrf_trf;
    add_patch(0.05);
    const PoseEstimate estimate = track({0.0, 3.0, 0.0}, second, 500'000);
    ASSERT_FALSE(estimate.evidence.fits());
    EXPECT_LE(estimate.evidence.cost_q8(), scratch_->other.evidence.cost_q8()) << k;
  }
}

// Returns beside the body. What the search started from is kept as the other one.
TEST_F(PoseAlternatives, AFirstFrameThatIsNotExplainedIsSearchedFurther) {
  see();
  add_patch(0.05);
  const PoseEstimate estimate = track({0.01, 0.02, -0.01}, truth_.r_lrf_trf, 0);
  ASSERT_EQ(estimate.evidence.dark_surfaces, 0);
  ASSERT_FALSE(estimate.evidence.fits());
  const PoseEvidence& other = scratch_->other.evidence;
  EXPECT_EQ(other.returned, estimate.evidence.returned);
  EXPECT_LE(estimate.evidence.cost_q8(), other.cost_q8());
}

// Near the sensor a part of the boom is too far beside the screen to be drawn, unless it is along the
// boresight.
TEST_F(PoseAlternatives, APoseThatIsNotDrawnWholeIsNotCompared) {
  constexpr std::uint32_t kEvenOdds_ppm = 1 << 20;
  take(body_with_boom());
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity(), along = rotation_of({0.0, 0.0, M_PI / 2});
  for (const bool is_across : {true, false}) {
    *state_ = {};
    truth_ = {is_across ? across : along, {0.0, 8.0, 0.0}};
    rate_ = {0.0, 0.0, 0.0};
    see();
    track({0.0, 0.0, 0.0}, is_across ? along : across, kEvenOdds_ppm);
    EXPECT_EQ(scratch_->best.refinement.is_complete, !is_across);
    EXPECT_EQ(state_->llr_q8, 0);
    EXPECT_EQ(state_->conservative_llr_q8, 0);
  }
}

// The network prefers the attitude at which the boom is across, where it is not drawn whole. Of that pose
// nothing is known, so it does not stand in the way of one that explains the frame, and gives it no
// advantage.
TEST_F(PoseAlternatives, APoseThatIsDrawnWholeAndExplainsTheFrameIsTaken) {
  take(body_with_boom());
  constexpr double kNear_deg = 2.0;  // the other attitude is 90 degrees away
  const Eigen::Matrix3d along = rotation_of({0.0, 0.0, M_PI / 2});
  for (const double range_m : {8.0, 9.0}) {
    for (const std::uint32_t odds_ppm : {300'000U, 1'000'000U}) {
      *state_ = {};
      truth_ = {along, {0.0, range_m, 0.0}};
      rate_ = {0.0, 0.0, 0.0};
      see();
      const Eigen::Vector3d to_across(0.0, 0.0, -M_PI / 2);
      const PoseEstimate estimate = track(to_across, along, odds_ppm);
      ASSERT_EQ(estimate.poses, 1);
      EXPECT_LT(error_deg(estimate), kNear_deg);
      EXPECT_EQ(state_->llr_q8, 0);
      EXPECT_EQ(state_->conservative_llr_q8, 0);
      see();
      EXPECT_LT(error_deg(track(to_across, along, odds_ppm)), kNear_deg);
    }
  }
}

// The network's choice was wrong and led to the track; its second attitude is the right one. However settled
// the track is, a frame that speaks against it leaves it unverified, and the third one ends it. (In a
// campaign of 224,000 sequences of NEAR 17 verified poses were wrong, since settled tracks were not compared
// with second attitudes.)
TEST_F(PoseAlternatives, ASettledTrackIsGivenUpForTheSecondAttitude) {
  follow_a_half_turn_beside_the_right_attitude();
  const Eigen::Vector3d to_the_track = -half_turn();
  for (int k = 0; k < 2; ++k) {
    see();
    const PoseEstimate estimate = track(to_the_track, truth_.r_lrf_trf, 10'000);
    EXPECT_NEAR(error_deg(estimate), 180.0, 3.0) << k;
    EXPECT_TRUE(estimate.evidence.fits()) << k;
    EXPECT_NE(estimate.doubts & kPoseAmbiguous, 0U) << k;
  }
  see();
  const PoseEstimate last = track(to_the_track, truth_.r_lrf_trf, 10'000);
  EXPECT_LT(error_deg(last), kLargestError_deg);
  EXPECT_EQ(last.poses, 1);
}

// The fewer returns there are, the less a frame tells of the knob.
// Verifies TS-EST-202.
TEST_F(PoseAlternatives, AFrameThatTakesMoreThanSixNatsFromATrackIsADoubt) {
  follow_a_half_turn_beside_the_right_attitude();
  const PoseTrackerState settled = *state_;
  const Eigen::Vector3d to_the_track = -half_turn();
  int doubtful = 0, sure = 0;
  for (lost_ = 0.0; lost_ < 0.9; lost_ += 0.02) {
    *state_ = settled;
    see();
    const PoseEstimate estimate = track(to_the_track, truth_.r_lrf_trf, 10'000);
    const bool is_doubtful = (estimate.doubts & kPoseAmbiguous) != 0;
    EXPECT_EQ(is_doubtful, kMostOfATrack_q8 - state_->llr_q8 > 6 * kNat_q8) << lost_;
    ++(is_doubtful ? doubtful : sure);
  }
  EXPECT_GT(doubtful, 0);
  EXPECT_GT(sure, 0);
}

TEST_F(PoseAlternatives, ATrackIsNotComparedWithASecondAttitudeOfLessThanOnePercent) {
  track_frames(3);
  see();
  track({0.0, 0.0, 0.0}, wrong(), 9'999);
  EXPECT_EQ(state_->llr_q8, 4 * kWithoutAlternative_q8);
}

// The poses are too old, but the attitude is where it was: nothing speaks for the new track yet.
TEST_F(PoseAlternatives, ATrackWithoutAPoseLeftBeginsWithoutAnAdvantage) {
  rate_ = Eigen::Vector3d::Zero();
  track_frames(4);
  period_ns_ = PoseHistory::kOldest_ns + 1;
  const PoseEstimate estimate = track_next();
  EXPECT_EQ(estimate.poses, 1);
  EXPECT_EQ(state_->llr_q8, kWithoutAlternative_q8);
  EXPECT_EQ(state_->conservative_llr_q8, kWithoutAlternative_q8);
}

// Both explain the frames. Of equals the network's choice counts.
TEST_F(PoseAlternatives, ATrackWhoseAdvantageIsLostIsGivenUp) {
  take_box();
  track_frames(4);
  see();
  state_->llr_q8 = -2 * kNat_q8;
  const PoseEstimate estimate = track(half_turn(), truth_.r_lrf_trf, 0);
  EXPECT_NEAR(error_deg(estimate), 180.0, 2.0);
  EXPECT_EQ(estimate.poses, 1);
  EXPECT_GT(state_->llr_q8, 0);
}

// The wrong attitude is compared, and this frame speaks against it. That so much spoke against the track
// before makes it no better.
TEST_F(PoseAlternatives, ATrackWithoutAdvantageIsNotGivenUpForAPoseThatCostsMore) {
  track_frames(4);
  see();
  state_->llr_q8 = -kMostOfATrack_q8;
  const PoseEstimate estimate = track({0.0, 0.0, 0.0}, wrong(), 500'000);
  EXPECT_EQ(state_->llr_q8, -kMostOfATrack_q8 + 16 * kNat_q8);
  EXPECT_EQ(estimate.poses, 5);
  EXPECT_LT(error_deg(estimate), kLargestError_deg);
}

// The network's attitude leads to the pose of the track in a frame that is not explained. Its second attitude
// is compared all the same.
TEST_F(PoseAlternatives, AFrameThatIsNotExplainedIsComparedWithTheSecondAttitude) {
  take_box();
  track_frames(4);
  noise_ = 1.5;
  see();
  const Eigen::Matrix3d second = rotation_of(half_turn()) * truth_.r_lrf_trf;
  const std::int32_t before_q8 = state_->llr_q8 = 2 * kNat_q8;
  const PoseEstimate estimate = track({0.01, 0.0, 0.01}, second, 500'000);
  ASSERT_GT(estimate.evidence.mean_square_q8(), 410);
  EXPECT_NEAR(angle_deg(exact(scratch_->other.refinement.pose).r_lrf_trf, truth_.r_lrf_trf), 180.0, 3.0);
  EXPECT_NE(state_->llr_q8 - before_q8, kWithoutAlternative_q8);
}

TEST_F(PoseAlternatives, ASettledTrackIsLostWhereOnlyTheNetworksAttitudeExplainsTheFrame) {
  follow_a_wrong_attitude();
  const PoseEstimate estimate = track_next();
  EXPECT_LT(error_deg(estimate), kLargestError_deg);
  EXPECT_EQ(estimate.poses, 1);
}

// A box with a small knob that turns it by a half turn: the network's attitude is better, but that of the
// track explains the frame too.
TEST_F(PoseAlternatives, ASettledTrackThatExplainsTheFrameStays) {
  follow_a_half_turn_beside_the_right_attitude();
  see();
  const Eigen::Vector3d back = -half_turn();
  const PoseEstimate estimate = track({0.0, 0.0, 0.0}, rotation_of(back) * truth_.r_lrf_trf, 0);
  EXPECT_LT(state_->llr_q8, kMostOfATrack_q8 - 2 * kNat_q8);
  EXPECT_NEAR(error_deg(estimate), 180.0, 3.0);
  EXPECT_EQ(estimate.poses, 5);
}

TEST_F(PoseAlternatives, ASettledTrackStaysWhereTheNetworksAttitudeDoesNotExplainTheFrame) {
  follow_a_wrong_attitude();
  const PoseTrackerState kept = *state_;
  const ExactPose pose = truth_;
  for (int k = 0; k < 3; ++k) {
    *state_ = kept;
    truth_ = pose;
    see_unexplained(k);
    const PoseEstimate estimate = track_seen();
    EXPECT_GT(error_deg(estimate), 90.0) << k;
  }
}

// A plate, seen from the side, and some returns beside it. If it stood across the boresight these would be
// explained, but half of its rays would have no return.
TEST_F(PoseAlternatives, ASettledTrackStaysWhereTheNetworksAttitudeCostsMore) {
  stated_noise_ = {2000, 0};  // the ranges tell nothing
  take(plate());
  truth_.r_lrf_trf = rotation_of({0.0, 0.0, 60.0 * kDegree});
  rate_ = Eigen::Vector3d::Zero();
  track_frames(4);
  see();
  for (int row = 57; row < 71; ++row)
    for (int column = 94; column < 106; ++column) frame_->add(row, column, kDepth_m);
  const PoseEstimate estimate = track({0.0, 0.0, -60.0 * kDegree}, truth_.r_lrf_trf, 0);
  EXPECT_GT(estimate.evidence.unexplained_ppm(), 30'000U);
  EXPECT_LE(scratch_->other.evidence.unexplained_ppm(), 30'000U);
  EXPECT_LE(scratch_->other.evidence.missing_ppm(), 690'000U);
  EXPECT_LE(scratch_->other.evidence.mean_square_q8(), 410);
  EXPECT_EQ(estimate.poses, 5);
  EXPECT_LT(error_deg(estimate), 20.0);
}

}  // namespace
}  // namespace tumblesight::gnc
