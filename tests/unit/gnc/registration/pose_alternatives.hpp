// PoseAlternatives: tracks of bodies that look much alike in another attitude.
#pragma once

#include "tests/unit/gnc/registration/track_pose.hpp"

namespace tumblesight::gnc {

inline constexpr std::int32_t kNat_q8 = 256;
inline constexpr std::int32_t kWithoutAlternative_q8 = 4 * kNat_q8;
inline constexpr std::int32_t kMostOfATrack_q8 = 32 * kNat_q8;

class PoseAlternatives : public TrackPose {
 protected:
  // Four poses that agree, of a target that then stands elsewhere.
  void follow_a_wrong_attitude() {
    track_frames(4);
    truth_.r_lrf_trf = wrong();
    state_->llr_q8 = kMostOfATrack_q8;
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
    state_->llr_q8 = state_->conservative_llr_q8 = kMostOfATrack_q8;
  }
  // Of the next frame, in which the network offers a half turn as its second attitude. The frame is then
  // forgotten.
  std::int32_t proven_against_a_half_turn_q8() {
    const PoseTrackerState settled = *state_;
    state_->conservative_llr_q8 = 0;
    see();
    track({0.0, 0.0, 0.0}, rotation_of(half_turn()) * truth_.r_lrf_trf, 500'000);
    const std::int32_t conservative_llr_q8 = state_->conservative_llr_q8;
    EXPECT_EQ(state_->history.count, settled.history.count + 1);  // the track goes on
    *state_ = settled;
    return conservative_llr_q8;
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

}  // namespace tumblesight::gnc
