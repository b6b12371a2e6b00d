#include "fsw/app/frame_handler.hpp"

#include "fsw/app/counter.hpp"
#include "fsw/app/cycle_deadline.hpp"
#include "gnc/estimation/covariance.hpp"

namespace tumblesight::fsw {
namespace {

using gnc::FrameVerdict;

// The report passes the tracker's doubts on as they are. An attitude that is unsound has no report.
static_assert(hal::kDoubtErrorLarge == gnc::kErrorLarge && hal::kDoubtAttitudeJump == gnc::kAttitudeJump &&
              hal::kDoubtRateAmbiguous == gnc::kRateAmbiguous &&
              hal::kDoubtChaserUnknown == gnc::kChaserUnknown &&
              hal::kDoubtChaserNowUnknown == gnc::kChaserNowUnknown &&
              hal::kDoubtUnexplained == gnc::kUnexplained);
static_assert(hal::kPoseDoubtUnknown == gnc::kPoseUnknown && hal::kPoseDoubtCoasts == gnc::kPoseCoasts &&
              hal::kPoseDoubtRanges == gnc::kPoseRanges && hal::kPoseDoubtOutline == gnc::kPoseOutline &&
              hal::kPoseDoubtAmbiguous == gnc::kPoseAmbiguous && hal::kPoseDoubtMotion == gnc::kPoseMotion &&
              hal::kPoseDoubtUncertain == gnc::kPoseUncertain && hal::kPoseDoubtNetwork == gnc::kPoseNetwork);

std::int32_t bits_of(std::uint32_t sequence_number) {
  return static_cast<std::int32_t>(sequence_number);
}

}  // namespace

void FrameHandler::refuse_all(const StepInputs& inputs, std::int32_t time_step_ms) {
  std::uint32_t refused = 0;
  if (state_.mode == Mode::kRun) {
    hal::Telemetry& counters = state_.counters;
    refused = static_cast<std::uint32_t>(inputs.deliveries());
    const auto wrong_size = static_cast<std::uint32_t>(inputs.frame_wrong_size);
    count(counters.frames_stale, refused - wrong_size);
    count(counters.frames_bad, wrong_size);
    count(counters.frames_refused, refused);
    count(counters.frames_overflowed, inputs.frames_overflowed);
    if (refused == 0) count(counters.frames_missing);
    outputs_.attitude.validity = refused > 0 ? Validity::kFrameRefused : Validity::kNoFrame;
  }
  report_(EventId::kCycleTimeNotAdvancing, time_step_ms, static_cast<std::int32_t>(refused));
}

void FrameHandler::take(const StepInputs& inputs) {
  count(state_.counters.frames_overflowed, inputs.frames_overflowed);
  count(state_.frames_unused, inputs.frames_overflowed);
  if (inputs.deliveries() == 0) {
    note_missing();
    return;
  }
  state_.outage = false;
  outputs_.attitude.validity = Validity::kFrameRefused;
  note_dropped(inputs);
  if (inputs.frame == nullptr) return;
  if (state_.long_task || !state_.has_model()) {
    pass_over();
  } else {
    use(inputs);
  }
}

void FrameHandler::note_missing() {
  outputs_.attitude.validity = Validity::kNoFrame;
  count(state_.counters.frames_missing);
  if (!state_.outage) report_(EventId::kFrameMissing, bits_of(state_.tracking.gate.last_sequence_number()));
  state_.outage = true;
}

void FrameHandler::note_dropped(const StepInputs& inputs) {
  for (int i = 0; i < inputs.frame_wrong_size; ++i) {
    count(state_.counters.frames_refused);
    count(state_.counters.frames_bad);
    report_(EventId::kFrameWrongSize);
  }
  for (int i = 0; i < inputs.dropped_count; ++i) {
    const DroppedFrame& dropped = inputs.dropped[static_cast<std::size_t>(i)];
    if (dropped.why == FrameVerdict::kBadContent) {
      note_bad_content(dropped.content, dropped.sequence_number, dropped.rays);
    } else {
      note_refusal(dropped.why, dropped.sequence_number, dropped.exposure_time_ns);
    }
  }
}

void FrameHandler::pass_over() {
  outputs_.attitude.validity = Validity::kPassedOver;
  count(state_.counters.frames_passed_over);
  count(state_.frames_unused);
}

void FrameHandler::use(const StepInputs& inputs) {
  const gnc::RangeImage& frame = *inputs.frame;
  CycleDeadline deadline(inputs.timing, state_.table[Parameter::kCycleBudget_us]);
  const gnc::FrameInputs frame_inputs{frame, inputs.chaser, inputs.chaser_now, state_.now_ns,
                                      inputs.timing.stopwatch != nullptr ? &deadline : nullptr};
  const gnc::FrameTrackerLimits limits = state_.tracker_limits();
  gnc::FrameOutcome& outcome = workspace_.outcome;
  hal::Telemetry& counters = state_.counters;
  hal::Stopwatch& stopwatch = *state_.platform.stopwatch;
  const std::uint64_t start_ns = stopwatch.now_ns();
  tracker_.use(frame_inputs, limits, state_.tracking, outcome);
  const std::uint64_t end_ns = stopwatch.now_ns();
  if (outcome.verdict == FrameVerdict::kBadContent) {
    note_bad_content(outcome.content, frame.sequence_number, frame.rays);
    return;
  }
  if (!outcome.used()) {
    note_refusal(outcome.verdict, frame.sequence_number, frame.exposure_time_ns);
    return;
  }
  counters.inference_us = elapsed_us(start_ns, end_ns);
  if (counters.inference_us > counters.inference_max_us) counters.inference_max_us = counters.inference_us;
  note_use(frame);
  if (outcome.estimate.pose.is_cut_short) note_cut_short(frame, deadline.since_start_us());
  tracker_.conclude(frame_inputs, limits, state_.tracking, outcome);
  report_attitude(frame, note_doubts(frame));
}

void FrameHandler::note_refusal(FrameVerdict verdict, std::uint32_t sequence_number,
                                std::int64_t exposure_time_ns) {
  hal::Telemetry& counters = state_.counters;
  const std::int32_t number = bits_of(sequence_number);
  if (verdict == FrameVerdict::kSuperseded) {
    count(counters.frames_superseded);
    count(state_.frames_unused);
    return;
  }
  count(counters.frames_refused);
  const std::int32_t since_last_ms =
      elapsed_ms(state_.tracking.gate.last_exposure_time_ns(), exposure_time_ns);
  switch (verdict) {
    case FrameVerdict::kDuplicate:
      count(counters.frames_duplicate);
      report_(EventId::kFrameDuplicate, number);
      return;
    case FrameVerdict::kFromFuture:
      count(counters.frames_stale);
      report_(EventId::kFrameFromFuture, number, elapsed_ms(state_.now_ns, exposure_time_ns));
      return;
    case FrameVerdict::kExposureBackwards:
      count(counters.frames_stale);
      report_(EventId::kFrameExposureBackwards, number, since_last_ms);
      return;
    case FrameVerdict::kStale:
      count(counters.frames_stale);
      report_(EventId::kFrameStale, number, elapsed_ms(exposure_time_ns, state_.now_ns));
      return;
    case FrameVerdict::kTooSoon:
      count(counters.frames_stale);
      report_(EventId::kFrameTooSoon, number, since_last_ms);
      return;
    case FrameVerdict::kRepeated:
      count(counters.frames_repeated);
      state_.faults_seen |= bit_of(Fault::kFrameFrozen);
      report_(EventId::kFrameRepeated, number);
      return;
    case FrameVerdict::kWithoutChaser:
      count(counters.frames_without_chaser);
      report_(EventId::kFrameWithoutChaser, number, since_last_ms);
      return;
    case FrameVerdict::kPass:
    case FrameVerdict::kBadContent:
    case FrameVerdict::kSuperseded:
      return;
  }
}

void FrameHandler::note_bad_content(gnc::FrameStatus content, std::uint32_t sequence_number,
                                    std::int32_t rays) {
  count(state_.counters.frames_refused);
  count(state_.counters.frames_bad);
  report_(EventId::kFrameBad, bits_of(sequence_number), static_cast<std::int32_t>(content), rays);
}

void FrameHandler::note_use(const gnc::RangeImage& frame) {
  const gnc::FrameOutcome& outcome = workspace_.outcome;
  hal::Telemetry& counters = state_.counters;
  // A frame that was superseded, passed over or dropped for lack of room did arrive.
  const bool went_back = outcome.numbers_skipped == gnc::FrameGate::kWentBack;
  if (outcome.numbers_skipped > state_.frames_unused) {
    const std::uint32_t skipped = went_back ? 1U : outcome.numbers_skipped - state_.frames_unused;
    count(counters.sequence_gaps, skipped);
    report_(EventId::kSequenceSkipped, bits_of(outcome.expected_number), bits_of(frame.sequence_number),
            went_back ? -1 : bits_of(skipped));
  }
  if (outcome.frames_given_up > 0) {
    count(counters.estimator_resets);
    report_(EventId::kEstimatorResetByGap, elapsed_ms(outcome.last_exposure_time_ns, frame.exposure_time_ns),
            clamp_to_int32(outcome.frames_given_up), outcome.chaser_changed ? 1 : 0);
  }
  count(counters.frames_used);
  state_.frames_unused = 0;
}

void FrameHandler::note_cut_short(const gnc::RangeImage& frame, std::uint32_t since_start_us) {
  count(state_.counters.registrations_cut_short);
  report_(EventId::kRegistrationCutShort, bits_of(frame.sequence_number),
          static_cast<std::int32_t>(since_start_us / 1000U));
}

// kFrameRefused: the attitude is unsound and must not be reported.
Validity FrameHandler::note_doubts(const gnc::RangeImage& frame) {
  const gnc::FrameOutcome& outcome = workspace_.outcome;
  const auto has = [&outcome](gnc::Doubts doubt) { return (outcome.doubts & doubt) != 0; };
  if (has(gnc::kAttitudeUnsound)) {
    state_.faults_seen |= bit_of(Fault::kAttitudeUnsound);
    return Validity::kFrameRefused;
  }
  if (has(gnc::kErrorLarge)) state_.faults_seen |= bit_of(Fault::kErrorLarge);
  if (has(gnc::kAttitudeJump)) state_.faults_seen |= bit_of(Fault::kAttitudeJump);
  if (outcome.valid()) return Validity::kValid;
  count(state_.counters.attitudes_doubtful);
  report_(EventId::kAttitudeDoubtful, bits_of(frame.sequence_number),
          static_cast<std::int32_t>(outcome.estimate.predicted_error_urad / 1000U),
          (has(gnc::kAttitudeJump) ? 1 : 0) + (has(gnc::kUnexplained) ? 2 : 0));
  return Validity::kDoubtful;
}

void FrameHandler::report_attitude(const gnc::RangeImage& frame, Validity validity) {
  if (validity == Validity::kFrameRefused) return;
  const gnc::FrameOutcome& outcome = workspace_.outcome;
  const gnc::AttitudeEstimate& estimate = outcome.estimate;
  hal::AttitudeReport& attitude = outputs_.attitude;
  attitude.exposure_time_ns = frame.exposure_time_ns;
  attitude.sequence_number = frame.sequence_number;
  attitude.validity = validity;
  attitude.frames_since_reset = estimate.frames_since_reset;
  attitude.q_lrf_trf = estimate.q_lrf_trf;
  attitude.q_lrf_trf_single_frame = estimate.q_lrf_trf_single_frame;
  attitude.predicted_error_urad = estimate.predicted_error_urad;
  attitude.predicted_error_single_frame_urad = estimate.predicted_error_single_frame_urad;
  attitude.law = static_cast<std::uint8_t>(estimate.motion_model);
  attitude.rate_lrf_urad_s = estimate.rate_lrf_urad_s;
  attitude.attitude_covariance_e8 = gnc::attitude_covariance(estimate.predicted_error_urad);
  attitude.rate_covariance_e8 = gnc::rate_covariance(
      estimate.predicted_error_urad,
      (outcome.doubts & gnc::kRateAmbiguous) != 0 ? 1 : estimate.frames_since_reset, outcome.elapsed_ns);
  attitude.doubts = static_cast<std::uint8_t>(outcome.doubts);
  attitude.q_lrf_trf_now = outcome.motion_now.q_lrf_trf;
  attitude.rate_lrf_now_urad_s = outcome.motion_now.rate_lrf_urad_s;
  attitude.q_lrf_trf_second = estimate.q_lrf_trf_second;
  attitude.second_odds_ppm = estimate.second_odds_ppm;
  attitude.centroid_lrf_mm = estimate.centroid_lrf_mm;
  report_pose();
}

void FrameHandler::report_pose() {
  const gnc::PoseEstimate& pose = workspace_.outcome.estimate.pose;
  hal::AttitudeReport& report = outputs_.attitude;
  report.pose_doubts = static_cast<std::uint8_t>(pose.doubts);
  note_verdict(pose);
  if (!pose.is_known()) return;
  report.pose_frames = static_cast<std::uint8_t>(pose.poses);
  report.pose_q_lrf_trf = pose.state.q_lrf_trf;
  report.pose_origin_lrf_um = pose.state.origin_lrf_um;
  report.pose_rate_lrf_urad_s = pose.state.rate_lrf_urad_s;
  report.pose_velocity_lrf_um_s = pose.state.velocity_lrf_um_s;
  report.pose_sigma = pose.covariance.sigma;
  report.pose_correlation_q15 = pose.covariance.correlation_q15;
  const gnc::PoseState& now = workspace_.outcome.pose_now;
  report.pose_q_lrf_trf_now = now.q_lrf_trf;
  report.pose_origin_lrf_now_um = now.origin_lrf_um;
  report.pose_rate_lrf_now_urad_s = now.rate_lrf_urad_s;
  report.pose_velocity_lrf_now_um_s = now.velocity_lrf_um_s;
  report.pose_mean_square_q8 = static_cast<std::uint32_t>(pose.evidence.mean_square_q8());
  report.pose_unexplained_ppm = pose.evidence.unexplained_ppm();
  report.pose_missing_ppm = pose.evidence.missing_ppm();
  report.pose_advantage_q8 = pose.conservative_llr_q8;
}

// Counts verified poses, and raises an event when the verdict changes.
void FrameHandler::note_verdict(const gnc::PoseEstimate& pose) {
  if (pose.is_verified()) count(state_.counters.poses_verified);
  if (pose.is_verified() == state_.pose_is_verified) return;
  state_.pose_is_verified = pose.is_verified();
  const std::int32_t number = bits_of(outputs_.attitude.sequence_number);
  if (pose.is_verified()) {
    report_(EventId::kPoseVerified, number, pose.poses);
  } else {
    report_(EventId::kPoseDoubtful, number, static_cast<std::int32_t>(pose.doubts));
  }
}

}  // namespace tumblesight::fsw
