#include "gnc/estimation/frame_tracker.hpp"

#include "gnc/attitude/quaternion.hpp"

namespace tumblesight::gnc {
namespace {

// The first frame of a track has no prediction, and the second one is predicted without a rate.
constexpr std::uint32_t kFirstCheckedFrame = 3;

bool is_sound(const AttitudeEstimate& estimate) {
  return is_unit(estimate.q_lrf_trf) && is_unit(estimate.q_lrf_trf_single_frame) &&
         estimate.predicted_error_urad <= kPi_urad && estimate.predicted_error_single_frame_urad <= kPi_urad;
}

bool holds_at(const ChaserAttitude& chaser, std::int64_t time_ns, std::int64_t tolerance_ns) {
  if (!chaser.valid || !is_unit(chaser.q_inertial_lrf)) return false;
  const auto later = static_cast<std::uint64_t>(max(chaser.time_ns, time_ns));
  const auto earlier = static_cast<std::uint64_t>(min(chaser.time_ns, time_ns));
  return later - earlier <= static_cast<std::uint64_t>(tolerance_ns);
}

// Whether the turn of the LRF since the last used frame is known.
bool knows_turn(const ChaserAttitude& chaser, std::int64_t time_ns, const FrameTrackerLimits& limits,
                const FrameTrackerState& state) {
  return state.has_chaser_attitude && holds_at(chaser, time_ns, limits.chaser_time_tolerance_ns);
}

// From the last used frame.
FrameInterval interval_until(std::int64_t time_ns, const ChaserAttitude& chaser,
                             const FrameTrackerLimits& limits, const FrameTrackerState& state) {
  FrameInterval interval;
  interval.elapsed_ns = time_after(state.gate.last_exposure_time_ns(), time_ns);
  if (knows_turn(chaser, time_ns, limits, state))
    interval.q_now_last = turn_of_lrf(state.q_inertial_lrf, chaser.q_inertial_lrf);
  return interval;
}

}  // namespace

QuaternionQ30 turn_of_lrf(const QuaternionQ30& q_inertial_lrf_last, const QuaternionQ30& q_inertial_lrf_now) {
  return product(conjugate(q_inertial_lrf_now), q_inertial_lrf_last);
}

template <class N>
void FrameTracker<N>::conclude(const FrameInputs& inputs, const FrameTrackerLimits& limits,
                               FrameTrackerState& state, FrameOutcome& outcome) const {
  check_attitude(limits, state, outcome);
  if ((outcome.doubts & kAttitudeUnsound) == 0) propagate(inputs, limits, state, outcome);
}

template <class N>
void FrameTracker<N>::use(const FrameInputs& inputs, const FrameTrackerLimits& limits,
                          FrameTrackerState& state, FrameOutcome& outcome) {
  const RangeImage& frame = inputs.frame;
  const ChaserAttitude& chaser = inputs.chaser;
  outcome.verdict = state.gate.judge(frame, inputs.now_ns, limits.time);
  if (!outcome.used()) return;
  const FrameSignature signature = signature_of(frame);
  if (state.history.contains(signature)) {
    outcome.verdict = FrameVerdict::kRepeated;
    return;
  }

  FrameInterval interval;
  outcome.last_exposure_time_ns = state.gate.last_exposure_time_ns();
  outcome.expected_number = state.gate.last_sequence_number() + 1U;
  outcome.elapsed_ns = state.gate.elapsed_ns(frame);
  interval.elapsed_ns = outcome.elapsed_ns;
  const bool knows_chaser = holds_at(chaser, frame.exposure_time_ns, limits.chaser_time_tolerance_ns);
  const bool track_knows_chaser = state.has_chaser_attitude;
  if (track_knows_chaser && !knows_chaser && outcome.elapsed_ns <= limits.longest_without_chaser_ns) {
    outcome.verdict = FrameVerdict::kWithoutChaser;
    return;
  }
  // Not used by the first frame of a track.
  if (knows_chaser) interval.q_now_last = turn_of_lrf(state.q_inertial_lrf, chaser.q_inertial_lrf);
  const std::uint32_t frames_before = estimator_.frames();
  const bool is_gap = outcome.elapsed_ns > limits.longest_coast_ns;
  interval.gives_up_track = is_gap || knows_chaser != track_knows_chaser;
  const bool continues_track = frames_before > 0 && !interval.gives_up_track;
  interval.rate_is_unknown = continues_track && !state.has_found_rate;
  outcome.content = estimator_.step(frame, interval, outcome.estimate, inputs.deadline);
  if (outcome.content != FrameStatus::kOk) {
    outcome.verdict = FrameVerdict::kBadContent;
    return;
  }

  outcome.numbers_skipped = state.gate.numbers_skipped(frame);
  outcome.frames_given_up = interval.gives_up_track ? frames_before : 0;
  if (outcome.frames_given_up > 0) state.forget_track();
  outcome.finds_no_rate = finds_no_rate(interval);
  state.has_found_rate = continues_track && !outcome.finds_no_rate;
  outcome.doubts = (outcome.finds_no_rate | outcome.estimate.rate_is_ambiguous) ? kRateAmbiguous : 0;
  outcome.chaser_changed = interval.gives_up_track && !is_gap;
  if (!knows_chaser) outcome.doubts |= kChaserUnknown;
  state.gate.accept(frame);
  if (knows_chaser) state.q_inertial_lrf = chaser.q_inertial_lrf;
  state.has_chaser_attitude = knows_chaser;
  state.history.add(signature);
}

void check_attitude(const FrameTrackerLimits& limits, FrameTrackerState& state, FrameOutcome& outcome) {
  const AttitudeEstimate& estimate = outcome.estimate;
  // The estimator returns sound attitudes for any frame and any model. Corrupted memory can break this.
  if (!is_sound(estimate)) {
    state.forget_track();
    outcome.doubts |= kAttitudeUnsound;
    return;
  }
  if (estimate.predicted_error_urad > limits.predicted_error_urad) outcome.doubts |= kErrorLarge;
  if (misfit_of(estimate.explained) > kLargestMisfit) outcome.doubts |= kUnexplained;
  const bool jumps = !outcome.finds_no_rate && estimate.frames_since_reset >= kFirstCheckedFrame &&
                     cos_half_angle(estimate.q_lrf_trf_predicted, estimate.q_lrf_trf) <
                         cos_half_of(limits.attitude_jump_urad);
  // After a jump the rate is uncertain for one more frame.
  if (jumps || state.has_jumped) outcome.doubts |= kAttitudeJump;
  state.has_jumped = jumps;
}

template <class N>
void FrameTracker<N>::propagate(const FrameInputs& inputs, const FrameTrackerLimits& limits,
                                const FrameTrackerState& state, FrameOutcome& outcome) const {
  if (!knows_turn(inputs.chaser_now, inputs.now_ns, limits, state)) outcome.doubts |= kChaserNowUnknown;
  const FrameInterval interval = interval_until(inputs.now_ns, inputs.chaser_now, limits, state);
  outcome.motion_now = estimator_.propagated(interval);
  if (outcome.estimate.pose.is_known()) outcome.pose_now = estimator_.propagated_pose(interval);
}

template class FrameTracker<FixedPoint>;
#if TUMBLESIGHT_FLOAT32
template class FrameTracker<Float32>;
#endif

}  // namespace tumblesight::gnc
