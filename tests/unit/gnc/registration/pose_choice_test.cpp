// Which other attitudes a frame is compared with, and when the track is given up for one of them.
#include "tests/support/trials.hpp"
#include "tests/unit/gnc/registration/track_pose.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::int32_t kNat_q8 = 256;
constexpr std::int32_t kWithoutAlternative_q8 = 4 * kNat_q8;
constexpr std::int32_t kMostOfATrack_q8 = 32 * kNat_q8;

class PoseAlternatives : public TrackPose {
 protected:
  // Four poses that agree, of a target that then stands elsewhere.
  void follow_a_wrong_attitude() {
    track_frames(4);
    truth_.r_lrf_trf = wrong();
    state_->advantage_q8 = kMostOfATrack_q8;
  }
  double error_deg(const PoseEstimate& estimate) const {
    return angle_deg(attitude_of(estimate), truth_.r_lrf_trf);
  }
  // The half turn of a box with a small knob explains the frames nearly as well.
  void take_box_with_a_knob() {
    Body box;
    box.radius_m = 2.5;
    box.add_box({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6});
    box.add_box({1.0, -0.1, 0.35}, {1.25, 0.1, 0.55});
    take(box);
    truth_.r_lrf_trf = rotation_of({0.1, 0.2, 0.1});
    rate_ = Eigen::Vector3d::Zero();
  }
  void follow_a_box_with_a_knob() {
    take_box_with_a_knob();
    track_frames(4);
  }
  void follow_a_half_turn_beside_the_right_attitude() {
    follow_a_box_with_a_knob();
    truth_.r_lrf_trf = rotation_of(half_turn()) * truth_.r_lrf_trf;
    state_->advantage_q8 = state_->proven_q8 = kMostOfATrack_q8;
  }
  // Of the next frame, in which the network offers a half turn as its second attitude. The frame is then
  // forgotten.
  std::int32_t proven_against_a_half_turn_q8() {
    const PoseTrackerState settled = *state_;
    state_->proven_q8 = 0;
    see();
    track({0.0, 0.0, 0.0}, rotation_of(half_turn()) * truth_.r_lrf_trf, 500'000);
    const std::int32_t proven_q8 = state_->proven_q8;
    EXPECT_EQ(state_->history.count, settled.history.count + 1);  // the track goes on
    *state_ = settled;
    return proven_q8;
  }
  // By how much the pose of the track costs less than the alternative [nats, Q8].
  std::int32_t difference_q8() const {
    return scratch_->other.evidence.cost_q8() - scratch_->best.evidence.cost_q8();
  }
  // About the boresight, far from every attitude that looks alike.
  Eigen::Matrix3d wrong() const { return rotation_of({0.0, 3.0, 0.0}) * truth_.r_lrf_trf; }
  // A box looks the same when it is turned by a half turn.
  void take_box() {
    Body box;
    box.radius_m = 2.5;
    box.add_box({-1.0, -0.8, -0.6}, {1.0, 0.8, 0.6});
    take(box);
  }
  Eigen::Vector3d half_turn() const { return truth_.r_lrf_trf * Eigen::Vector3d(0.0, 0.0, M_PI); }
};

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
  EXPECT_EQ(state_->advantage_q8, kWithoutAlternative_q8);
}

TEST_F(PoseAlternatives, FramesWithoutOneAddFourNatsEachUpTo32) {
  for (int k = 1; k < 10; ++k) {
    EXPECT_EQ(track_next().proven_q8, std::min(k * kWithoutAlternative_q8, kMostOfATrack_q8)) << k;
    EXPECT_EQ(state_->advantage_q8, state_->proven_q8) << k;
  }
}

// Registered from eight degrees off it ends at the pose of the track.
TEST_F(PoseAlternatives, AnAttitudeThatLeadsToTheSamePoseIsNone) {
  track_frames(3);
  const std::int32_t before_q8 = state_->advantage_q8;
  network_turn_ = Eigen::Vector3d(0.0, 0.0, 8.0 * kDegree);
  track_next();
  EXPECT_EQ(state_->advantage_q8, before_q8 + kWithoutAlternative_q8);
}

// The network prefers the second attitude by four nats. The frame tells nothing, and the first stays, with
// less than nothing in favour of it.
TEST_F(PoseAlternatives, AFirstAttitudeThatIsSlightlyWorseStays) {
  take_box();
  see();
  const Eigen::Matrix3d second = rotation_of(half_turn()) * truth_.r_lrf_trf;
  const PoseEstimate estimate = track({0.01, 0.0, 0.01}, second, 1'000'000'000);
  EXPECT_LT(state_->advantage_q8, 0);
  EXPECT_GE(state_->advantage_q8, -6 * kNat_q8);
  EXPECT_LE(state_->proven_q8, state_->advantage_q8);
  EXPECT_LT(error_deg(estimate), 2.0);
}

TEST_F(PoseAlternatives, ASecondAttitudeThatIsTakenHasTheAdvantage) {
  see();
  track({0.0, 3.0, 0.0}, truth_.r_lrf_trf, 500'000);
  EXPECT_GE(state_->advantage_q8, 6 * kNat_q8);
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
    const PoseEstimate estimate = track({0.0, 0.0, 0.0}, is_across ? along : across, kEvenOdds_ppm);
    EXPECT_EQ(scratch_->best.refinement.is_complete, !is_across);
    EXPECT_FALSE(scratch_->other.refinement.is_complete);
    EXPECT_EQ(state_->advantage_q8, 0);
    EXPECT_EQ(state_->proven_q8, 0);
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
      EXPECT_EQ(state_->advantage_q8, 0);
      EXPECT_EQ(state_->proven_q8, 0);
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
    EXPECT_EQ(is_doubtful, kMostOfATrack_q8 - state_->advantage_q8 > 6 * kNat_q8) << lost_;
    ++(is_doubtful ? doubtful : sure);
  }
  EXPECT_GT(doubtful, 0);
  EXPECT_GT(sure, 0);
}

// The right attitude, too, explains nothing if its refinement goes astray. (Of 2,500 sequences of NEAR with
// 32 rays 31 ended with a verified pose that was wrong, mostly because of such frames.)
// Verifies TS-EST-202.
TEST_F(PoseAlternatives, AnAlternativeThatDoesNotExplainTheFrameProvesA32ndUpTo16Nats) {
  track_frames(3);
  state_->proven_q8 = 0;
  see();
  track({0.0, 0.0, 0.0}, rotation_of({0.0, 25.0 * kDegree, 0.0}) * truth_.r_lrf_trf, 500'000);
  ASSERT_FALSE(scratch_->other.evidence.fits());
  ASSERT_GT(difference_q8(), 32 * 16 * kNat_q8);
  EXPECT_EQ(state_->proven_q8, 16 * kNat_q8);
}

// Verifies TS-EST-202.
TEST_F(PoseAlternatives, AnAlternativeProvesTheDifferenceUpToSixNatsIfItExplainsTheFrame) {
  follow_a_box_with_a_knob();
  int misfits = 0, fits = 0, limited = 0;
  for (lost_ = 0.0; lost_ < 0.7; lost_ += 0.05) {
    const std::int32_t proven_q8 = proven_against_a_half_turn_q8();
    if (scratch_->other.evidence.fits()) {
      EXPECT_EQ(proven_q8, std::min(difference_q8(), 6 * kNat_q8)) << lost_;
      ++fits;
      limited += proven_q8 == 6 * kNat_q8 ? 1 : 0;
    } else {
      ASSERT_LT(difference_q8(), 32 * 16 * kNat_q8);
      EXPECT_EQ(proven_q8, difference_q8() / 32) << lost_;
      ++misfits;
    }
  }
  EXPECT_GT(fits, 0);
  EXPECT_GT(limited, 0);
  EXPECT_GT(misfits, 0);
}

// The half turn of a box explains the frame as well.
// Verifies TS-EST-202.
TEST_F(PoseAlternatives, AnAlternativeThatLooksAlikeProvesNoMoreThanTheDifference) {
  take_box();
  rate_ = Eigen::Vector3d::Zero();
  track_frames(4);
  int below_zero = 0;
  for (int k = 0; k < 10; ++k) {
    const std::int32_t proven_q8 = proven_against_a_half_turn_q8();
    ASSERT_TRUE(scratch_->other.evidence.fits());
    ASSERT_LT(std::abs(difference_q8()), 6 * kNat_q8);
    EXPECT_EQ(proven_q8, difference_q8());
    below_zero += proven_q8 < 0 ? 1 : 0;
  }
  EXPECT_GT(below_zero, 0);
}

// Verifies TS-EST-202.
TEST_F(PoseAlternatives, WhereTheNetworkDisagreesFourNatsLessAreProven) {
  follow_a_half_turn_beside_the_right_attitude();
  state_->proven_q8 = 0;
  see();
  track({0.0, 0.0, 0.0}, rotation_of(-half_turn()) * truth_.r_lrf_trf, 0);
  ASSERT_TRUE(scratch_->other.evidence.fits());
  EXPECT_EQ(state_->proven_q8, std::clamp(difference_q8(), -16 * kNat_q8, 6 * kNat_q8) - 4 * kNat_q8);
}

// The second attitude of the first frame is registered in two steps. With even odds the advantage is the
// difference of the costs, unless it is limited.
// Verifies TS-EST-202.
TEST_F(PoseAlternatives, ASecondAttitudeOfAFirstFrameProvesA16thOrA32nd) {
  constexpr std::uint32_t kEvenOdds_ppm = 1 << 20;
  take_box_with_a_knob();
  int fits = 0, misfits = 0;
  for (lost_ = 0.0; lost_ < 0.95; lost_ += 0.01) {
    *state_ = {};
    see();
    const Eigen::Matrix3d half = rotation_of(half_turn()) * truth_.r_lrf_trf;
    track({0.0, 0.0, 0.0}, half, kEvenOdds_ppm);
    const std::int32_t advantage_q8 = state_->advantage_q8, proven_q8 = state_->proven_q8;
    if (advantage_q8 <= 0 || advantage_q8 == 16 * kNat_q8) continue;
    EXPECT_TRUE(proven_q8 == advantage_q8 / 16 || proven_q8 == advantage_q8 / 32) << lost_;
    ++(proven_q8 == advantage_q8 / 16 ? fits : misfits);
  }
  EXPECT_GT(fits, 0);
  EXPECT_GT(misfits, 0);
}

TEST_F(PoseAlternatives, ASecondAttitudeThatIsTakenProvesNoMoreThanOneThatIsNot) {
  constexpr std::uint32_t kEvenOdds_ppm = 1 << 20;
  take_box_with_a_knob();
  see();
  track(half_turn(), truth_.r_lrf_trf, kEvenOdds_ppm);
  EXPECT_EQ(state_->advantage_q8, 16 * kNat_q8);
  EXPECT_GT(state_->proven_q8, 0);
  EXPECT_LE(state_->proven_q8, 6 * kNat_q8);
}

// Whatever the attitudes that the network offers, no more is proven than the costs say.
// Verifies TS-EST-202.
TEST_F(PoseAlternatives, NoMoreIsProvenThanTheAdvantage) {
  take_box_with_a_knob();
  int less = 0, as_much = 0;
  for (int sequence = 0; sequence < trials(40); ++sequence) {
    *state_ = {};
    for (int k = 0; k < 6; ++k) {
      lost_ = 0.1 * (k % 4);
      see();
      const Eigen::Vector3d half = half_turn();
      const auto offered = [&]() -> Eigen::Vector3d {
        return random_.happens(0.5) ? half : Eigen::Vector3d(random_.vector(0.2));
      };
      const Eigen::Vector3d first = offered();
      track(first, rotation_of(offered()) * truth_.r_lrf_trf, 1U << ((7 * sequence + 5 * k) % 32));
      EXPECT_LE(state_->proven_q8, state_->advantage_q8) << sequence << ", " << k;
      ++(state_->proven_q8 < state_->advantage_q8 ? less : as_much);
    }
  }
  EXPECT_GT(less, 0);
  EXPECT_GT(as_much, 0);
}

// Verifies TS-EST-202.
TEST_F(PoseAlternatives, AFrameThatThePoseDoesNotExplainProvesNothing) {
  for (int kind = 0; kind < 4; ++kind) {
    *state_ = {};
    track_frames(4);
    const std::int32_t before_q8 = state_->proven_q8;
    see_unexplained(kind);
    track_seen();
    ASSERT_FALSE(scratch_->best.evidence.fits()) << kind;
    EXPECT_EQ(state_->proven_q8, before_q8) << kind;
    noise_ = 1.0;
    lost_ = 0.0;
  }
}

// Verifies TS-EST-202.
TEST_F(PoseAlternatives, OfATrackThatBeginsAnewNothingIsProven) {
  follow_a_wrong_attitude();
  state_->proven_q8 = kMostOfATrack_q8;
  const PoseEstimate estimate = track_next();
  ASSERT_EQ(estimate.poses, 1);
  EXPECT_EQ(estimate.proven_q8, 0);
}

TEST_F(PoseAlternatives, ATrackIsNotComparedWithASecondAttitudeOfLessThanOnePercent) {
  track_frames(3);
  see();
  track({0.0, 0.0, 0.0}, wrong(), 9'999);
  EXPECT_EQ(state_->advantage_q8, 4 * kWithoutAlternative_q8);
}

// The poses are too old, but the attitude is where it was: nothing speaks for the new track yet.
TEST_F(PoseAlternatives, ATrackWithoutAPoseLeftBeginsWithoutAnAdvantage) {
  rate_ = Eigen::Vector3d::Zero();
  track_frames(4);
  period_ns_ = PoseHistory::kOldest_ns + 1;
  const PoseEstimate estimate = track_next();
  EXPECT_EQ(estimate.poses, 1);
  EXPECT_EQ(state_->advantage_q8, kWithoutAlternative_q8);
  EXPECT_EQ(state_->proven_q8, kWithoutAlternative_q8);
}

// Both explain the frames. Of equals the network's choice counts.
TEST_F(PoseAlternatives, ATrackWhoseAdvantageIsLostIsGivenUp) {
  take_box();
  track_frames(4);
  see();
  state_->advantage_q8 = -2 * kNat_q8;
  const PoseEstimate estimate = track(half_turn(), truth_.r_lrf_trf, 0);
  EXPECT_NEAR(error_deg(estimate), 180.0, 2.0);
  EXPECT_EQ(estimate.poses, 1);
  EXPECT_GT(state_->advantage_q8, 0);
}

// The wrong attitude is compared, and this frame speaks against it. That so much spoke against the track
// before makes it no better.
TEST_F(PoseAlternatives, ATrackWithoutAdvantageIsNotGivenUpForAPoseThatCostsMore) {
  track_frames(4);
  see();
  state_->advantage_q8 = -kMostOfATrack_q8;
  const PoseEstimate estimate = track({0.0, 0.0, 0.0}, wrong(), 500'000);
  EXPECT_EQ(state_->advantage_q8, -kMostOfATrack_q8 + 16 * kNat_q8);
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
  const std::int32_t before_q8 = state_->advantage_q8 = 2 * kNat_q8;
  const PoseEstimate estimate = track({0.01, 0.0, 0.01}, second, 500'000);
  ASSERT_GT(estimate.evidence.mean_square_q8(), 410);
  EXPECT_NEAR(angle_deg(exact(scratch_->other.refinement.pose).r_lrf_trf, truth_.r_lrf_trf), 180.0, 3.0);
  EXPECT_NE(state_->advantage_q8 - before_q8, kWithoutAlternative_q8);
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
  EXPECT_LT(state_->advantage_q8, kMostOfATrack_q8 - 2 * kNat_q8);
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
