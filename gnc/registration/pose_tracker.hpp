// Pose tracker: from the attitudes that the network offers to a pose with rates, covariance and a verdict.
//
// - First frames: the network's attitude and its second one are registered shortly. The one that explains
//   the frame better is registered fully.
// - Later frames: from two poses on, the motion predicts the next pose, which is registered. If it does not
//   explain the frame, the network's attitude is registered as well. Another one that the network offers is
//   registered shortly.
// - Log-likelihood ratio (LLR): by how much the pose of the track explains the frames better than the
//   alternatives, summed over the frames. Below zero the track starts anew at the alternative. A conservative
//   LLR is summed apart: it counts less where an alternative does not explain a frame, since its registration
//   may have gone astray. In the report it is the proven advantage.
// - Motion: fitted to the last ten poses (pose_fit.hpp).
// - Verdict: the frame must agree with the pose in ranges and silhouette, the conservative LLR must be large,
//   and the poses must agree with one motion.
//
// Specification: docs/numerics.md.
#pragma once

#include <array>
#include <cstdint>

#include "gnc/registration/pose_covariance.hpp"
#include "gnc/registration/pose_track.hpp"

namespace tumblesight::gnc {

// Bit mask: why a pose is not verified. The values are part of the interface (docs/icd.md).
using PoseDoubts = std::uint32_t;
inline constexpr PoseDoubts kPoseUnknown = 1;  // no surface in the image, the target too near, or no pose yet
inline constexpr PoseDoubts kPoseCoasts = 2;   // predicted: the frame could not be registered
inline constexpr PoseDoubts kPoseRanges = 4;   // the ranges do not lie on the surface
// Returns beside the surface, too many missing, or its silhouette elsewhere.
inline constexpr PoseDoubts kPoseOutline = 8;
// The conservative log-likelihood ratio is small, another attitude explains this frame better, or work budget
// or deadline did not allow for the registration or its comparison with another attitude.
inline constexpr PoseDoubts kPoseAmbiguous = 16;
// Fewer than three poses, they contradict one motion, or they are too far apart to tell the rate.
inline constexpr PoseDoubts kPoseMotion = 32;
inline constexpr PoseDoubts kPoseUncertain = 64;  // the attitude is known to a degree at best
inline constexpr PoseDoubts kPoseNetwork = 128;   // the network's attitude is another one

// A motion in the integers of the interface.
struct PoseState {
  QuaternionQ30 q_lrf_trf = kIdentityQ30;
  std::array<std::int32_t, 3> origin_lrf_um{};      // of the TRF
  std::array<std::int32_t, 3> rate_lrf_urad_s{};    // of the target relative to the inertial frame
  std::array<std::int32_t, 3> velocity_lrf_um_s{};  // of the TRF's origin relative to the sensor
};
PoseState pose_state(const PoseMotion& motion);

struct PoseEstimate {
  PoseDoubts doubts = kPoseUnknown;  // none: verified
  PoseState state;                   // at the exposure, in the LRF of the exposure
  PoseCovariance covariance;
  PoseEvidence evidence;                 // of this frame at its registered pose
  std::int32_t conservative_llr_q8 = 0;  // over the alternatives, as far as it is proven [nats]
  std::int64_t disagreement_q8 = 0;      // PoseFitResult
  int poses = 0;                         // that the motion was fitted to
  bool is_cut_short = false;             // the deadline passed before all of the frame's work was done

  bool is_known() const { return (doubts & kPoseUnknown) == 0; }
  bool is_verified() const { return doubts == 0; }
};

// The motion of the track `elapsed_ns` after the last frame, in an LRF that has turned: `r_now_last`.
PoseMotion later_pose(const PoseTrackerState& state, const MotionModels<Fixed>& motion_models,
                      std::int64_t elapsed_ns, const Matrix3<Fixed>& r_now_last);

// Advances the track to a frame. `state` of a new track: PoseTrackerState(). A frame whose registration
// exhausts `budget` before it has a pose counts as one that could not be registered. So does one that has
// none at `deadline`, if that is not nullptr. After the deadline at most kBetweenLooks and one charge are
// spent, and the one fit that every frame makes.
void track_pose(const PoseTarget& target, const PoseFrame& frame, PoseScratch& scratch,
                ScreenVertices& vertices, PoseTrackerState& state, PoseEstimate& estimate,
                std::int32_t budget = WorkBudget::kOfAFrame, Deadline* deadline = nullptr);

}  // namespace tumblesight::gnc
