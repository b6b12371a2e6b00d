// The verdict: each doubt alone, by the one thing that is wrong with a frame or a track.
#include "tests/unit/gnc/registration/track_pose.hpp"

namespace tumblesight::gnc {
namespace {

class PoseVerdict : public TrackPose {
 protected:
  // A track of seven poses that is verified.
  void verify() { ASSERT_EQ(track_frames(7).doubts, 0U); }
  // With more rays on the target and a fifteenth of the noise, so that its poses are known well.
  void see_more_sharply() {
    sensor_ = {128, 8.0};
    noise_ = 1.0 / 15.0;
    stated_noise_ = {20, 0};
  }
};

// Verifies TS-EST-202.
TEST_F(PoseVerdict, RangesBesideTheSurfaceAreADoubt) {
  verify();
  noise_ = 1.5;
  EXPECT_EQ(track_next().doubts, kPoseRanges);
  noise_ = 1.0;
  EXPECT_EQ(track_next().doubts, 0U);
}

// Returns of the target where it is not: a twentieth of all, in a corner of the frame.
// Verifies TS-EST-202.
TEST_F(PoseVerdict, ReturnsBesideTheTargetAreADoubt) {
  verify();
  see();
  add_patch(0.05);
  EXPECT_EQ(track_seen().doubts, kPoseOutline);
  see();
  add_patch(0.02);
  EXPECT_EQ(track_seen().doubts, 0U);
}

// Verifies TS-EST-202.
TEST_F(PoseVerdict, ASilhouetteThatIsTooSmallIsADoubt) {
  verify();
  see();
  lose_rim();
  EXPECT_EQ(track_seen().doubts, kPoseOutline);
  EXPECT_LT(scratch_->best.evidence.missing_ppm(), 10'000U);
  EXPECT_EQ(track_next().doubts, 0U);
}

// Verifies TS-EST-202.
TEST_F(PoseVerdict, TooManyMissingReturnsAreADoubt) {
  verify();
  lost_ = 0.75;
  EXPECT_EQ(track_next().doubts, kPoseOutline);
  lost_ = 0.6;
  EXPECT_EQ(track_next().doubts, 0U);
}

// Four nats a frame without an alternative: just below 8, then 8 of the 8 that are needed.
// Verifies TS-EST-202.
TEST_F(PoseVerdict, TooSmallAProvenAdvantageIsADoubt) {
  verify();
  state_->conservative_llr_q8 = 4 * 256 - 1;
  EXPECT_EQ(track_next().doubts, kPoseAmbiguous);
  state_->conservative_llr_q8 = 4 * 256;
  EXPECT_EQ(track_next().doubts, 0U);
}

// Verifies TS-EST-202.
TEST_F(PoseVerdict, FewerThanThreePosesAreADoubt) {
  track_next();
  EXPECT_EQ(track_next().doubts, kPoseMotion);
  EXPECT_EQ(track_next().doubts, 0U);
}

// A target that is pushed up and down by a centimetre beside its motion, as by thrusters. No single pose is
// far from the motion, but together they do not follow it.
// Verifies TS-EST-202.
TEST_F(PoseVerdict, PosesThatDoNotFollowOneMotionAreADoubt) {
  see_more_sharply();
  track_frames(10);
  int doubtful = 0;
  for (int k = 0; k < 8; ++k) {
    const ExactPose undisturbed = truth_;
    truth_.origin_m.z() += k % 2 == 0 ? 0.01 : -0.01;
    const PoseEstimate estimate = track_next();
    truth_.origin_m = undisturbed.origin_m;
    // Poses that agree less are known less well.
    EXPECT_EQ(estimate.doubts & ~kPoseUncertain, estimate.disagreement_q8 > 3 * 256 ? kPoseMotion : 0U) << k;
    doubtful += (estimate.doubts & kPoseMotion) != 0 ? 1 : 0;
  }
  EXPECT_GT(doubtful, 0);
}

// The target jumps. On average the ten poses agree.
// Verifies TS-EST-202.
TEST_F(PoseVerdict, ANewestPoseThatContradictsTheOthersIsADoubt) {
  see_more_sharply();
  track_frames(10);
  truth_.r_lrf_trf = rotation_of({0.0, 0.0, 2.5 * kDegree}) * truth_.r_lrf_trf;
  const PoseEstimate estimate = track_next();
  EXPECT_LE(estimate.disagreement_q8, 3 * 256);
  EXPECT_EQ(estimate.doubts, kPoseMotion);
}

// Frames further apart than 7.5 s fit a rate that is one turn per period off as well.
// Verifies TS-EST-202.
TEST_F(PoseVerdict, PosesTooFarApartToTellTheRateAreADoubt) {
  rate_ = {0.02, -0.01, 0.015};
  period_ns_ = 7'500'000'001;
  for (int k = 0; k < 6; ++k) {
    pass_until(period_ns_);
    const PoseEstimate estimate = track_next();
    EXPECT_EQ(estimate.doubts, k > 0 ? kPoseMotion : kPoseMotion | kPoseAmbiguous) << k;
  }
  period_ns_ = 7'500'000'000;
  pass_until(period_ns_);
  EXPECT_EQ(track_next().doubts, 0U);
}

// A ball looks the same however it is turned.
// Verifies TS-EST-202.
TEST_F(PoseVerdict, AnAttitudeThatIsKnownToADegreeAtBestIsADoubt) {
  take(ball());
  rate_ = Eigen::Vector3d::Zero();
  const PoseEstimate estimate = track_frames(12);
  EXPECT_EQ(estimate.doubts, kPoseUncertain);
  EXPECT_GT(*std::max_element(estimate.covariance.sigma.begin(), estimate.covariance.sigma.begin() + 3),
            17'453U);
}

// Verifies TS-EST-202.
TEST_F(PoseVerdict, AnotherAttitudeOfTheNetworkIsADoubt) {
  verify();
  see();
  EXPECT_EQ(track({0.0, 21.0 * kDegree, 0.0}, truth_.r_lrf_trf, 0).doubts, kPoseNetwork);
  see();
  EXPECT_EQ(track({0.0, 19.0 * kDegree, 0.0}, truth_.r_lrf_trf, 0).doubts, 0U);
}

// The sensor narrows its field of view until a part of the target is too far from the middle of the screen.
// What is left of it agrees with the frame.
// Verifies TS-EST-202.
TEST_F(PoseVerdict, AFrameInWhichTheTargetIsNotDrawnWholeIsADoubt) {
  take(body_with_boom());
  truth_.r_lrf_trf = Eigen::Matrix3d::Identity();
  rate_ = Eigen::Vector3d::Zero();
  verify();
  sensor_ = {128, 5.5};
  EXPECT_EQ(track_next().doubts, kPoseCoasts);
}

// Verifies TS-EST-202.
TEST_F(PoseVerdict, AFrameThatCannotBeRegisteredInANewTrackGivesNoPose) {
  see();
  frame_.emplace(sensor_);
  EXPECT_EQ(track_seen().doubts, kPoseUnknown);
  EXPECT_EQ(track_next().poses, 1);
}

}  // namespace
}  // namespace tumblesight::gnc
