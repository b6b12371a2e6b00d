#include "gnc/registration/pose_tracker.hpp"

#include "tests/unit/gnc/registration/track_pose.hpp"

namespace tumblesight::gnc {
namespace {

// Verifies TS-EST-200, TS-EST-202.
TEST_F(TrackPose, IsVerifiedFromTheThirdFrameAndWithinItsCovariance) {
  for (int k = 0; k < 10; ++k) {
    const PoseEstimate estimate = track_next();
    ASSERT_TRUE(estimate.is_known()) << k;
    EXPECT_EQ(estimate.poses, k + 1);
    EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg) << k;
    EXPECT_EQ((estimate.doubts & kPoseMotion) != 0, k < 2) << k;
    if (k < 2) continue;
    EXPECT_EQ(estimate.doubts, 0U) << k;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_NEAR(1e-6 * estimate.state.origin_lrf_um[at], truth_.origin_m[i],
                  5e-6 * estimate.covariance.sigma[6 + at]);
      EXPECT_NEAR(1e-6 * estimate.state.rate_lrf_urad_s[at], rate_[i] / 2.7,
                  5e-6 * estimate.covariance.sigma[3 + at]);
      EXPECT_NEAR(1e-6 * estimate.state.velocity_lrf_um_s[at], 0.0, 5e-6 * estimate.covariance.sigma[9 + at]);
    }
  }
}

// Verifies TS-EST-204.
TEST_F(TrackPose, TakesTheSecondAttitudeWhereItExplainsTheFrameBetter) {
  see();
  const Eigen::Matrix3d right = rotation_of(random_.vector(kDegree)) * truth_.r_lrf_trf;
  const PoseEstimate estimate = track({0.0, 0.0, 3.0}, right, 500'000);  // the first is 172 degrees off
  EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg);
  EXPECT_NE(estimate.doubts & kPoseNetwork, 0U);
  EXPECT_FALSE(estimate.is_verified());
}

TEST_F(TrackPose, KeepsTheFirstAttitudeWhereTheSecondIsWrong) {
  see();
  const Eigen::Matrix3d wrong = rotation_of({0.0, 0.0, 3.0}) * truth_.r_lrf_trf;
  const PoseEstimate estimate = track({0.01, 0.0, 0.01}, wrong, 900'000);
  EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg);
  EXPECT_GT(state_->llr_q8, 5 * 256);
}

// A wrong start is left as soon as the network shows the right attitude.
// Verifies TS-EST-204.
TEST_F(TrackPose, LeavesAWrongTrackForTheNetworksAttitude) {
  for (int k = 0; k < 3; ++k) {
    see();
    track({0.0, 3.0, 0.0}, truth_.r_lrf_trf, 0);
  }
  PoseEstimate estimate;
  for (int k = 0; k < 6; ++k) estimate = track_next();
  EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg);
  EXPECT_EQ(estimate.doubts, 0U);
}

// The network's choice is the wrong track's attitude, a few degrees off: what it offers is its second one.
TEST_F(TrackPose, LeavesAWrongTrackForTheNetworksSecondAttitude) {
  for (int k = 0; k < 3; ++k) {
    see();
    track({0.0, 3.0, 0.0}, truth_.r_lrf_trf, 0);
  }
  PoseEstimate estimate;
  for (int k = 0; k < 3; ++k) {
    see();
    const Eigen::Matrix3d offered = rotation_of(random_.vector(kDegree)) * truth_.r_lrf_trf;
    estimate = track({0.0, 3.0 + 10.0 * kDegree, 0.0}, offered, 200'000);
  }
  EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg);
}

// Its rate does not lead from one pose to the next.
TEST_F(TrackPose, FindsTheRateWhereTheNetworksIsWrong) {
  rate_error_ = {0.0, 1.5, 0.0};
  PoseEstimate estimate;
  for (int k = 0; k < 6; ++k) estimate = track_next();
  EXPECT_EQ(estimate.poses, 6);
  EXPECT_EQ(estimate.doubts, 0U);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(1e-6 * estimate.state.rate_lrf_urad_s[static_cast<std::size_t>(i)], rate_[i] / 2.7,
                5e-6 * estimate.covariance.sigma[static_cast<std::size_t>(3 + i)]);
}

// Two frames whose second attitude is as good as the first, and then none: nothing was compared in that
// frame.
TEST_F(TrackPose, IsNotGivenUpInAFrameWithoutAnAlternative) {
  for (int k = 0; k < 2; ++k) track_next();
  state_->llr_q8 = state_->conservative_llr_q8 = -10 * 256;
  for (int k = 0; k < 2; ++k) {
    const PoseEstimate estimate = track_next();
    EXPECT_EQ(estimate.poses, 3 + k);
    EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg);
    EXPECT_NE(estimate.doubts & kPoseAmbiguous, 0U);
  }
}

// What spoke for one attitude in the first frame does not speak for another one in the second.
TEST_F(TrackPose, AnotherFirstAttitudeBeginsWithoutAnAdvantage) {
  see();
  const Eigen::Matrix3d wrong = rotation_of({0.0, 3.0, 0.0}) * truth_.r_lrf_trf;
  track({0.0, 0.01, 0.0}, wrong, 900'000);
  EXPECT_GT(state_->llr_q8, 5 * 256);
  see();
  track({0.0, 3.0, 0.0}, wrong, 0);
  EXPECT_LE(state_->llr_q8, 4 * 256);
  EXPECT_LE(state_->conservative_llr_q8, 4 * 256);
}

// Frames far apart fit a rate that is one turn per period off as well.
// Verifies TS-EST-202.
TEST_F(TrackPose, PosesFarApartDoNotTellTheRate) {
  period_ns_ = 3 * kNominalPeriod_ns;
  rate_ = {0.02, -0.01, 0.015};
  for (int k = 0; k < 6; ++k) {
    for (int more = 0; more < 2; ++more) pass_a_period();
    EXPECT_NE(track_next().doubts & kPoseMotion, 0U) << k;
  }
}

// And a right track stays while the network is wrong, and says so.
TEST_F(TrackPose, KeepsARightTrackWhileTheNetworkIsWrong) {
  for (int k = 0; k < 4; ++k) track_next();
  for (int k = 0; k < 3; ++k) {
    see();
    const PoseEstimate estimate = track({0.0, 3.0, 0.0}, truth_.r_lrf_trf, 0);
    EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg) << k;
    EXPECT_EQ(estimate.doubts, kPoseNetwork) << k;
  }
}

// Verifies TS-EST-202.
TEST_F(TrackPose, AnotherBodyIsNotVerified) {
  shown_ = Body();
  shown_.radius_m = 2.5;
  shown_.add_box({-1.2, -1.2, -1.2}, {1.2, 1.2, 1.2});
  for (int k = 0; k < 6; ++k) EXPECT_FALSE(track_next().is_verified()) << k;
}

// The network says that the target spins. Its poses tell that it tumbles.
// Verifies TS-EST-206.
TEST_F(TrackPose, FindsTheMotionModel) {
  tumble();
  PoseEstimate estimate;
  for (int k = 0; k < 10; ++k) estimate = track_next();
  EXPECT_EQ(state_->motion_model, kTumbleModel);
  EXPECT_EQ(estimate.doubts, 0U);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(1e-6 * estimate.state.rate_lrf_urad_s[static_cast<std::size_t>(i)], rate_[i] / 2.7,
                5e-6 * estimate.covariance.sigma[static_cast<std::size_t>(3 + i)]);
}

TEST_F(TrackPose, WithoutAMeshThereIsNoPose) {
  for (int k = 0; k < 3; ++k) track_next();
  has_mesh_ = false;
  EXPECT_EQ(track_next().doubts, kPoseUnknown);
  EXPECT_EQ(state_->history.count, 0);
}

TEST_F(TrackPose, WithinTwoRadiiThereIsNoPose) {
  track_frames(3);
  radius_mm_ = 12'000;
  const PoseEstimate estimate = track_next();
  EXPECT_EQ(estimate.doubts, kPoseUnknown);
  EXPECT_EQ(estimate.state.q_lrf_trf, kIdentityQ30);
}

// The target rests, and the sensor turns: in the LRF the target turns about the sensor.
TEST_F(TrackPose, FollowsTheTurnOfTheSensor) {
  rate_ = Eigen::Vector3d::Zero();
  turn_of_sensor_ = rotation_of({0.005, 0.01, -0.004});
  PoseEstimate estimate;
  for (int k = 0; k < 6; ++k) {
    if (k > 0) {
      truth_.r_lrf_trf = turn_of_sensor_ * truth_.r_lrf_trf;
      truth_.origin_m = turn_of_sensor_ * truth_.origin_m;
    }
    estimate = track_next();
  }
  EXPECT_EQ(estimate.doubts, 0U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(estimate.state.rate_lrf_urad_s[i], 0.0, 5.0 * estimate.covariance.sigma[3 + i]);
    EXPECT_NEAR(estimate.state.velocity_lrf_um_s[i], 0.0, 5.0 * estimate.covariance.sigma[9 + i]);
  }
}

TEST_F(TrackPose, AFrameWithoutReturnsOfTheTargetCoasts) {
  PoseEstimate before;
  for (int k = 0; k < 5; ++k) before = track_next();
  see();
  frame_.emplace(kSensor);
  const PoseEstimate estimate = track({0.0, 0.0, 0.0}, truth_.r_lrf_trf, 0);
  EXPECT_NE(estimate.doubts & kPoseCoasts, 0U);
  EXPECT_LT(angle_deg(attitude_of(estimate), truth_.r_lrf_trf), kLargestError_deg);
  for (std::size_t i = 0; i < 12; ++i) {  // of turn, rate, position, velocity
    EXPECT_GT(estimate.covariance.sigma[i], 0U) << i;
    if (i % 6 >= 3) continue;
    EXPECT_GE(estimate.covariance.sigma[i], before.covariance.sigma[i]) << i;
  }
  EXPECT_EQ(track_next().doubts, 0U);
}

// Else its position would be integrated for ever.
TEST_F(TrackPose, WithoutAPoseThereIsNoMotion) {
  truth_.origin_m.x() = -1.0;
  for (int k = 0; k < 4; ++k) {
    truth_.origin_m.x() += 0.3;
    track_next();
  }
  EXPECT_NE(state_->motion.velocity_um_period[0], 0);
  has_mesh_ = false;
  for (int k = 0; k < 2; ++k) track_next();
  EXPECT_EQ(state_->motion.velocity_um_period, PoseMotion().velocity_um_period);
  EXPECT_EQ(state_->motion.origin_lrf_um, PoseMotion().origin_lrf_um);
}

// Every bit of the number of poses, as radiation may flip it.
TEST_F(TrackPose, ADamagedNumberOfPosesIsLimited) {
  for (int k = 0; k < 3; ++k) track_next();
  see();
  const PoseTrackerState kept = *state_;
  for (int bit = 0; bit < 32; ++bit) {
    *state_ = kept;
    state_->history.count = static_cast<int>(static_cast<std::uint32_t>(kept.history.count) ^ (1U << bit));
    const PoseEstimate estimate = track({0.0, 0.0, 0.0}, truth_.r_lrf_trf, 0);
    EXPECT_GE(estimate.poses, 0) << bit;
    EXPECT_LE(estimate.poses, PoseHistory::kMost) << bit;
  }
}

// Bits of the state, as radiation may flip them between the check of the state and its use: every one of the
// numbers behind the poses, and some of the poses. In the sanitizers' build also: without an overflow.
TEST_F(TrackPose, ADamagedStateIsUsedWithinItsLimits) {
  track_frames(3);
  see();
  const PoseTrackerState kept = *state_;
  auto* const bytes = reinterpret_cast<std::uint8_t*>(state_.get());
  constexpr std::size_t kSomeBits = 97, kFirst = 8 * offsetof(PoseTrackerState, motion_model);
  for (std::size_t bit = 0; bit < 8 * sizeof(PoseTrackerState); bit += bit < kFirst ? kSomeBits : 1) {
    *state_ = kept;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    const PoseEstimate estimate = track({0.0, 0.0, 0.0}, truth_.r_lrf_trf, 0);
    EXPECT_LE(estimate.poses, 4) << bit;
    EXPECT_LE(std::abs(state_->llr_q8), 32 * 256) << bit;
    EXPECT_LE(std::abs(state_->conservative_llr_q8), 32 * 256) << bit;
    EXPECT_LE(state_->conservative_llr_q8, state_->llr_q8) << bit;
    EXPECT_NEAR(to_double(estimate.state.q_lrf_trf).norm(), 1.0, 1e-6) << bit;
  }
}

// Every bit of the numbers of vertices in the surface, which is read where it lies.
TEST_F(TrackPose, ADamagedSurfaceIsDrawnWithinItsVertices) {
  for (int k = 0; k < 3; ++k) track_next();
  see();
  const PoseTrackerState kept = *state_;
  const SurfaceMesh mesh = section_.mesh();
  const std::size_t first =
      SurfaceMesh::kHeaderBytes + std::size_t{6} * static_cast<std::size_t>(mesh.vertices());
  for (std::size_t byte = first; byte < section_.bytes().size(); ++byte) {
    for (int bit = 0; bit < 8; bit += 7) {
      *state_ = kept;
      section_.bytes()[byte] ^= static_cast<std::uint8_t>(1U << bit);
      EXPECT_LE(track({0.0, 0.0, 0.0}, truth_.r_lrf_trf, 0).poses, 4);
      section_.bytes()[byte] ^= static_cast<std::uint8_t>(1U << bit);
    }
  }
}

TEST_F(TrackPose, LaterPoseIsWhereTheTargetIsThen) {
  for (int k = 0; k < 6; ++k) track_next();
  const PoseState later =
      pose_state(later_pose(*state_, motion_models_, kNominalPeriod_ns / 2, Matrix3<Fixed>::Identity()));
  const Eigen::Matrix3d expected = rotation_of(0.5 * rate_) * truth_.r_lrf_trf;
  EXPECT_LT(angle_deg(to_double(later.q_lrf_trf).normalized().toRotationMatrix(), expected),
            kLargestError_deg);
}

}  // namespace
}  // namespace tumblesight::gnc
