// FrameTracker processes one frame: it admits the frame, runs the estimator, checks the attitude and
// propagates it to the time of the cycle. Pure: the flight application and the evaluation on the ground call
// the same function.
//
//   admission   time and order (frame_gate.hpp); a frame that repeats one of the last eight used
//               ones (frame_signature.hpp) is refused before the estimator sees it, across gaps and resets
//   gap         the track coasts over the time since the last used frame; after more than longest_coast_ns it
//               is given up, and the frame starts a new one
//   chaser      a track with the chaser's attitude turns with the LRF, by the attitudes at both exposures. A
//               track without it assumes a chaser that does not turn, and each outcome says so. A track with
//               it refuses a frame without it; after more than longest_without_chaser_ns such a frame starts
//               a track without. In a track without, a frame with the attitude starts a track with it. A
//               single unknown turn of 13 degrees would spoil the rate for the next ten frames
//   checks      expected error, distance from the attitude that the track predicted, and how much of the
//               frame the target explains at the attitude
#pragma once

#include <array>
#include <cstdint>

#include "gnc/attitude/chaser_attitude.hpp"
#include "gnc/estimation/attitude_estimator.hpp"
#include "gnc/estimation/frame_gate.hpp"
#include "gnc/estimation/frame_signature.hpp"

namespace tumblesight::gnc {

struct FrameTrackerLimits {
  FrameTimeLimits time;
  std::int64_t longest_coast_ns;           // between the exposures of two used frames
  std::int64_t longest_without_chaser_ns;  // since the last used frame, in a track with its attitude
  std::int64_t chaser_time_tolerance_ns;   // between the chaser's attitude and the exposure
  std::uint32_t predicted_error_urad;      // a larger expected error is a doubt
  std::uint32_t attitude_jump_urad;        // a larger distance from the predicted attitude is a doubt
};

// What is kept from frame to frame, beside the estimator's state.
struct FrameTrackerState {
  FrameGate gate;
  QuaternionQ30 q_inertial_lrf = kIdentityQ30;  // of the LiDAR, at the last used frame for which it was known
  bool has_chaser_attitude = false;             // q_inertial_lrf is that of the last used frame
  bool has_jumped = false;                      // the last attitude was a jump
  bool has_found_rate = false;                  // of the track: two frames were close enough in time
  FrameHistory history;                         // of the used frames

  // The estimator was reset: its next attitude has no predecessor to compare with.
  void forget_track() { has_jumped = has_chaser_attitude = false; }
  // The times and numbers of earlier frames say nothing about the next one. The history still does.
  void forget_times() {
    gate.forget();
    has_chaser_attitude = false;
  }
};

// Bit mask: why an attitude is not valid, or what is missing from it.
using Doubts = std::uint32_t;
inline constexpr Doubts kErrorLarge = 1;    // expected error above its limit
inline constexpr Doubts kAttitudeJump = 2;  // too far from the predicted one, in this frame or the one before
inline constexpr Doubts kAttitudeUnsound = 4;  // not a unit quaternion, or an expected error above pi
inline constexpr Doubts kRateAmbiguous =
    8;  // AttitudeEstimate::rate_is_ambiguous, or a track that cannot know its rate; the attitude is valid
inline constexpr Doubts kChaserUnknown = 16;     // in the whole track; the attitude is valid
inline constexpr Doubts kChaserNowUnknown = 32;  // motion_now is in the LRF of the exposure
inline constexpr Doubts kUnexplained =
    64;  // the target at this attitude does not explain what the frame shows
inline constexpr Doubts kAgainstAttitude = kErrorLarge | kAttitudeJump | kAttitudeUnsound | kUnexplained;

// Largest misfit_of() of an attitude that the frame confirms: docs/numerics.md has the figures behind it.
inline constexpr std::uint32_t kLargestMisfit = 53 * kWholeShare / 100;

// A frame and what is known with it.
struct FrameInputs {
  const RangeImage& frame;
  const ChaserAttitude& chaser;      // at the exposure
  const ChaserAttitude& chaser_now;  // at the time of the cycle
  std::int64_t now_ns;               // time of the cycle
  Deadline* deadline = nullptr;      // of the registration; nullptr: none
};

// Everything that is known of a frame after its step.
struct FrameOutcome {
  FrameVerdict verdict = FrameVerdict::kPass;
  FrameStatus content = FrameStatus::kOk;  // if the verdict is kBadContent
  // The following are valid if the frame was used.
  Doubts doubts = 0;
  std::int64_t last_exposure_time_ns = 0;  // of the last used frame before it
  std::uint32_t expected_number = 0;       // sequence number after that of the last used frame
  std::int64_t elapsed_ns = 0;             // since the last used frame; 0: there is none
  std::uint32_t numbers_skipped = 0;       // FrameGate::numbers_skipped()
  std::uint32_t frames_given_up = 0;       // of the track that ends before this frame; 0: none does
  bool finds_no_rate = false;              // finds_no_rate(): no jump check
  bool chaser_changed = false;             // it ends because the chaser's attitude became known or unknown
  AttitudeEstimate estimate;
  // At the time of the cycle, in the LRF of that time; with kChaserNowUnknown in that of the exposure. Not if
  // the attitude is unsound.
  PropagatedMotion motion_now;
  PoseState pose_now;  // if there is a pose

  bool used() const { return verdict == FrameVerdict::kPass; }
  bool valid() const { return used() && (doubts & kAgainstAttitude) == 0; }
};

// Turn of the LRF from `last` to `now`: v_lrf now = q v_lrf last.
QuaternionQ30 turn_of_lrf(const QuaternionQ30& q_inertial_lrf_last, const QuaternionQ30& q_inertial_lrf_now);

// Checks the attitude of a frame that was used: adds to its doubts.
void check_attitude(const FrameTrackerLimits& limits, FrameTrackerState& state, FrameOutcome& outcome);

template <class N>
class FrameTracker {
 public:
  // `estimator` must have a model.
  explicit FrameTracker(AttitudeEstimator<N>& estimator) : estimator_(estimator) {}

  // Uses or refuses one frame, checks its attitude and propagates it to the time of the cycle. A refused
  // frame changes neither `state` nor the estimator.
  void step(const FrameInputs& inputs, const FrameTrackerLimits& limits, FrameTrackerState& state,
            FrameOutcome& outcome) {
    use(inputs, limits, state, outcome);
    if (outcome.used()) conclude(inputs, limits, state, outcome);
  }
  // The two halves of step(), for a caller that measures the time of the first: admission and estimator;
  // then, for a frame that was used, checks and propagation.
  void use(const FrameInputs& inputs, const FrameTrackerLimits& limits, FrameTrackerState& state,
           FrameOutcome& outcome);
  void conclude(const FrameInputs& inputs, const FrameTrackerLimits& limits, FrameTrackerState& state,
                FrameOutcome& outcome) const;

 private:
  void propagate(const FrameInputs& inputs, const FrameTrackerLimits& limits, const FrameTrackerState& state,
                 FrameOutcome& outcome) const;

  AttitudeEstimator<N>& estimator_;
};

}  // namespace tumblesight::gnc
