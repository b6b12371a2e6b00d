// How a frame is registered: where the fit starts, in how many steps, and under which motion models.
#include "tests/unit/gnc/registration/track_pose.hpp"

namespace tumblesight::gnc {
namespace {

// From the predicted pose: in a long track, and else (docs/numerics.md, Track).
constexpr RefinementSettings kTwoSteps{2, 1, 80, 40, 838861, 8388608};
constexpr RefinementSettings kTwoMore{2, 1, 160, 40, 838861, 8388608};
constexpr RefinementSettings kThreeSteps{3, 1, 160, 40, 838861, 8388608};

class PoseSteps : public TrackPose {
 protected:
  // Tracks the frame; whether it was registered in these steps from the pose that the track predicted.
  bool tracks_in(const RefinementSettings& settings, const RefinementSettings* more = nullptr) {
    const PoseMotion predicted =
        later_pose(*state_, motion_models_, period_ns_, fixed_rotation(turn_of_sensor_));
    const auto view = view_of(*frame_, 1e-6 * predicted.origin_lrf_um[1], body_.radius_m, stated_noise_);
    RefinementScratch& scratch = *expected_scratch_;
    scratch.surface.vertices = vertices_.get();
    Refinement expected;
    refine(section_.mesh(), *view, {predicted.turning.r_lrf_trf, predicted.origin_lrf_um}, settings, scratch,
           expected);
    if (more != nullptr) refine_further(section_.mesh(), *view, *more, scratch, expected);
    track_seen();
    const Pose& pose = scratch_->best.refinement.pose;
    return pose.r_lrf_trf == expected.pose.r_lrf_trf && pose.origin_lrf_um == expected.pose.origin_lrf_um;
  }

  std::unique_ptr<RefinementScratch> expected_scratch_ = std::make_unique<RefinementScratch>();
};

TEST_F(PoseSteps, FromFourPosesOnTwoAreEnough) {
  track_frames(2);
  for (int poses = 2; poses < 6; ++poses) {
    see();
    EXPECT_TRUE(tracks_in(poses < 4 ? kThreeSteps : kTwoSteps)) << poses;
  }
}

TEST_F(PoseSteps, AfterAGapThreeAreNeeded) {
  for (const std::int64_t beyond_ns : {0, 1}) {
    *state_ = {};
    period_ns_ = kNominalPeriod_ns;
    track_frames(4);
    period_ns_ = 3 * kNominalPeriod_ns / 2 + beyond_ns;
    pass_until(period_ns_);
    see();
    EXPECT_TRUE(tracks_in(beyond_ns == 0 ? kTwoSteps : kThreeSteps)) << beyond_ns;
  }
}

// By noisy ranges, missing returns, returns beside the target or a silhouette that is too small.
TEST_F(PoseSteps, AFrameThatIsNotExplainedIsRegisteredInTwoMore) {
  track_frames(4);
  state_->llr_q8 = 32 * 256;  // so that one frame does not end the track
  const PoseTrackerState kept = *state_;
  const ExactPose pose = truth_;
  for (int k = 0; k < 4; ++k) {
    *state_ = kept;
    truth_ = pose;
    see_unexplained(k);
    network_turn_ = Eigen::Vector3d(0.0, 25.0 * kDegree, 0.0);  // too far to be tried as well
    EXPECT_TRUE(tracks_in(kTwoSteps, &kTwoMore)) << k;
  }
}

// The target is neither where its motion leads nor turned so, by more than the steps from there reach. From
// the network's attitude they reach it, unless that is more than 20 degrees away, too.
TEST_F(PoseSteps, AFrameThatTheTrackDoesNotExplainIsAlsoRegisteredFromTheNetworksAttitude) {
  for (const double network_deg : {2.0, 45.0}) {
    *state_ = {};
    truth_.origin_m = {0.1, kDepth_m, -0.05};
    network_turn_.reset();
    track_frames(4);
    pass_a_period();
    truth_.r_lrf_trf = rotation_of({15.0 * kDegree, 0.0, 0.0}) * truth_.r_lrf_trf;
    truth_.origin_m += Eigen::Vector3d(0.4, 0.0, 0.4);
    frames_ = 0;  // the period has passed
    see();
    network_turn_ = Eigen::Vector3d(network_deg * kDegree, 0.0, 0.0);
    track_seen();
    const double off_deg = angle_deg(exact(scratch_->best.refinement.pose).r_lrf_trf, truth_.r_lrf_trf);
    EXPECT_EQ(off_deg < kLargestError_deg, network_deg < 20.0) << off_deg;
  }
}

// A pose counts 1/16 of its information in the motion if more than an eighth of the rays next to its
// silhouette are not as drawn, and 1/256 from three sixteenths on.
TEST_F(PoseSteps, APoseThatItsSilhouetteContradictsCountsLess) {
  std::array<int, 9> poses{};  // by the shift of their information
  track_frames(4);
  const PoseTrackerState kept = *state_;
  const ExactPose pose = truth_;
  for (double share = 0.0; share < 1.0; share += 0.05) {
    *state_ = kept;
    truth_ = pose;
    see();
    lose_rim(share);
    const PoseEvidence evidence = track_seen().evidence;
    ASSERT_EQ(evidence.missing, 0);
    const int shift = 8 * evidence.silhouette <= evidence.silhouette_rays        ? 0
                      : 16 * evidence.silhouette <= 3 * evidence.silhouette_rays ? 4
                                                                                 : 8;
    const Refinement& refinement = scratch_->best.refinement;
    const PoseMeasurement whole = measured_pose(refinement.pose, refinement.equations);
    const PoseMeasurement& newest =
        state_->history.poses[static_cast<std::size_t>(state_->history.count - 1)];
    for (std::size_t i = 0; i < whole.information.size(); ++i)
      ASSERT_EQ(newest.information[i], whole.information[i] >> shift) << share;
    ++poses[static_cast<std::size_t>(shift)];
  }
  EXPECT_GT(poses[0], 0);
  EXPECT_GT(poses[4], 0);
  EXPECT_GT(poses[8], 0);
}

// A plate that turns its edge to the sensor: all of it is seen, but no range tells where it is.
TEST_F(PoseSteps, AFrameWithoutARangeThatCountsIsNotExplained) {
  take(plate());
  truth_.r_lrf_trf = rotation_of({0.0, 0.0, 55.0 * kDegree});
  rate_ = {0.0, 0.0, 5.0 * kDegree};
  track_frames(5);
  see();
  EXPECT_TRUE(tracks_in(kTwoSteps, &kTwoMore));
  EXPECT_EQ(scratch_->best.evidence.blocks, 0);
  EXPECT_LE(scratch_->best.evidence.missing_ppm(), 690'000U);
  EXPECT_LE(scratch_->best.evidence.unexplained_ppm(), 30'000U);
  *state_ = {};
  truth_.r_lrf_trf = rotation_of({0.0, 0.0, 50.0 * kDegree});
  track_frames(6);
  const PoseEstimate estimate = track_next();
  // How well the frames before tell the plate's turn does not matter.
  EXPECT_EQ(estimate.doubts & ~kPoseUncertain, kPoseCoasts | kPoseRanges);
}

// Its origin is not in its middle, by more than the fit bridges.
TEST_F(PoseSteps, TheFirstFrameStartsAtTheMiddleOfTheReturns) {
  Body body = lopsided_body();
  body.radius_m = 4.0;
  for (Eigen::Vector3d& corner : body.corners) corner += Eigen::Vector3d(1.2, 0.0, 0.9);
  take(body);
  truth_.r_lrf_trf = rotation_of({0.0, 0.3, 0.2});
  truth_.origin_m = Eigen::Vector3d(0.0, kDepth_m, 0.0) - truth_.r_lrf_trf * Eigen::Vector3d(1.2, 0.0, 0.9);
  EXPECT_LT(angle_deg(attitude_of(track_next()), truth_.r_lrf_trf), kLargestError_deg);
}

// Something hides the target, so that nothing pulls the pose either.
TEST_F(PoseSteps, WithoutReturnsTheFirstFrameStartsAtTheCentroid) {
  frame_.emplace(sensor_);
  for (int row = 0; row < sensor_.rays; ++row)
    for (int column = 0; column < sensor_.rays; ++column) frame_->hide(row, column, 5.0);
  centroid_m_ = {0.5, kDepth_m, -0.25};
  track_seen();
  EXPECT_EQ(scratch_->best.refinement.pose.origin_lrf_um,
            (std::array<std::int32_t, 3>{500'000, 20'000'000, -250'000}));
}

TEST_F(PoseSteps, OutOfViewTheFirstFrameStartsAtTheCentroid) {
  see();
  centroid_m_ = {12.0, kDepth_m, 0.0};
  track_seen();
  EXPECT_EQ(scratch_->best.refinement.pose.origin_lrf_um,
            (std::array<std::int32_t, 3>{12'000'000, 20'000'000, 0}));
}

TEST_F(PoseSteps, PosesThatAgreeAreFittedOnceAndUnderOneMotionModel) {
  const PoseFitResult untouched = [this] {
    std::memset(static_cast<void*>(scratch_.get()), 0xA5, sizeof *scratch_);
    return scratch_->other_fit;
  }();
  for (int k = 0; k < 8; ++k) {
    track_next();
    EXPECT_EQ(scratch_->other_fit.disagreement_q8, untouched.disagreement_q8) << k;
    EXPECT_EQ(state_->challenger, kTumbleModel) << k;
  }
}

// Two poses that no rate joins tell nothing of the motion model.
TEST_F(PoseSteps, TwoPosesAreFittedUnderOneMotionModel) {
  rate_ = Eigen::Vector3d::Zero();
  track_next();
  truth_.r_lrf_trf = rotation_of({0.0, 170.0 * kDegree, 0.0}) * truth_.r_lrf_trf;
  track_next();
  EXPECT_EQ(state_->challenger, kTumbleModel);
}

// A body that tumbles, in a track that takes it to spin. Between the challengers there is the network's
// motion model, if it is another one than the track's.
TEST_F(PoseSteps, MotionModelsTakeTurnsWithTheNetworks) {
  tumble();
  for (int k = 0; k < 6; ++k) {
    state_->challenger = 0;  // the next one is the spin
    track_next();
  }
  ASSERT_EQ(state_->motion_model, kSpinModel);
  see();
  const PoseTrackerState kept = *state_;
  const auto motion_model_after = [&](int challenger, int network_motion_model) {
    *state_ = kept;
    state_->challenger = challenger;
    network_motion_model_ = network_motion_model;
    track_seen();
    return state_->motion_model;
  };
  EXPECT_EQ(motion_model_after(3, kTumbleModel), kTumbleModel);  // the network's turn
  EXPECT_NE(motion_model_after(4, kTumbleModel), kTumbleModel);  // that of motion model 2
  EXPECT_EQ(motion_model_after(1, kSpinModel),
            kTumbleModel);  // the network's, but the track follows that already
}

}  // namespace
}  // namespace tumblesight::gnc
