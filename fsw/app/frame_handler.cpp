#include "fsw/app/frame_handler.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

std::int32_t bits_of(std::uint32_t sequence_number) {
  return static_cast<std::int32_t>(sequence_number);
}

bool is_sound(const gnc::AttitudeEstimate& estimate) {
  return is_unit(estimate.q_lrf_trf) && is_unit(estimate.q_lrf_trf_single_frame) &&
         estimate.predicted_error_urad <= gnc::kPi_urad &&
         estimate.predicted_error_single_frame_urad <= gnc::kPi_urad;
}

}  // namespace

void FrameHandler::refuse_all(const StepInputs& inputs, std::int32_t time_step_ms) {
  std::uint32_t refused = 0;
  if (state_.mode == Mode::kRun) {
    hal::Telemetry& counters = state_.counters;
    count(counters.frames_stale, static_cast<std::uint32_t>(inputs.frames()));
    count(counters.frames_bad, static_cast<std::uint32_t>(inputs.frame_wrong_size));
    refused = static_cast<std::uint32_t>(inputs.frames() + inputs.frame_wrong_size);
    count(counters.frames_refused, refused);
    if (refused == 0) count(counters.frames_missing);
    outputs_.attitude.validity = refused > 0 ? Validity::kFrameRefused : Validity::kNoFrame;
  }
  report_(EventId::kCycleTimeNotAdvancing, time_step_ms, static_cast<std::int32_t>(refused));
}

void FrameHandler::take(const StepInputs& inputs) {
  if (inputs.frames() + inputs.frame_wrong_size == 0) {
    note_missing();
    return;
  }
  state_.outage = false;
  outputs_.attitude.validity = Validity::kFrameRefused;
  for (int i = 0; i < inputs.frame_wrong_size; ++i) {
    count(state_.counters.frames_refused);
    count(state_.counters.frames_bad);
    report_(EventId::kFrameWrongSize);
  }
  for (int i = 0; i < inputs.frames(); ++i) {
    if (!use(inputs.frame[i])) count(state_.counters.frames_refused);
  }
}

void FrameHandler::note_missing() {
  outputs_.attitude.validity = Validity::kNoFrame;
  count(state_.counters.frames_missing);
  if (!state_.outage) report_(EventId::kFrameMissing, bits_of(state_.gate.last_sequence_number()));
  state_.outage = true;
}

// False: the frame was refused. If the model was lost in this cycle, no frame can be used; the response to
// that fault follows after the frames.
bool FrameHandler::use(const gnc::RangeImage& frame) {
  if (!state_.has_model()) return false;
  if (!passes_gate(frame)) return false;
  if (!estimate(frame)) return false;
  report_attitude(frame, check_attitude(frame));
  return true;
}

bool FrameHandler::passes_gate(const gnc::RangeImage& frame) {
  hal::Telemetry& counters = state_.counters;
  const std::int32_t number = bits_of(frame.sequence_number);
  switch (state_.gate.judge(frame, state_.now_ns)) {
    case FrameVerdict::kPass:
      return true;
    case FrameVerdict::kDuplicate:
      count(counters.frames_duplicate);
      report_(EventId::kFrameDuplicate, number);
      return false;
    case FrameVerdict::kFromFuture:
      count(counters.frames_stale);
      report_(EventId::kFrameFromFuture, number, elapsed_ms(state_.now_ns, frame.exposure_time_ns));
      return false;
    case FrameVerdict::kExposureBackwards:
      count(counters.frames_stale);
      report_(EventId::kFrameExposureBackwards, number,
              elapsed_ms(state_.gate.last_exposure_time_ns(), frame.exposure_time_ns));
      return false;
    case FrameVerdict::kStale:
      count(counters.frames_stale);
      report_(EventId::kFrameStale, number, elapsed_ms(frame.exposure_time_ns, state_.now_ns));
      return false;
  }
  return false;
}

// Runs the estimator. False: it has refused the content of the frame, and its state is unchanged.
bool FrameHandler::estimate(const gnc::RangeImage& frame) {
  // The reset precedes the step, but a refused frame must leave the state unchanged.
  estimator_.save(workspace_.state_before);
  const std::uint32_t frames_before = workspace_.state_before.track.frames;
  const bool reset_by_gap = frames_before > 0 && !state_.gate.one_period_after_last(frame);
  if (reset_by_gap) estimator_.reset();

  hal::Telemetry& counters = state_.counters;
  hal::Stopwatch& stopwatch = *state_.platform.stopwatch;
  const std::uint64_t start_ns = stopwatch.now_ns();
  const gnc::FrameStatus status = estimator_.step(frame, workspace_.estimate);
  if (status != gnc::FrameStatus::kOk) {
    estimator_.restore(workspace_.state_before);
    count(counters.frames_bad);
    report_(EventId::kFrameBad, bits_of(frame.sequence_number), static_cast<std::int32_t>(status),
            frame.rays);
    return false;
  }
  counters.inference_us = elapsed_us(start_ns, stopwatch.now_ns());
  if (counters.inference_us > counters.inference_max_us) counters.inference_max_us = counters.inference_us;

  count_skipped(frame);
  if (reset_by_gap) {
    count(counters.estimator_resets);
    state_.attitude_check.forget();
    report_(EventId::kEstimatorResetByGap,
            elapsed_ms(state_.gate.last_exposure_time_ns(), frame.exposure_time_ns),
            clamp_to_int32(frames_before));
  }
  state_.gate.accept(frame);
  count(counters.frames_used);
  return true;
}

void FrameHandler::count_skipped(const gnc::RangeImage& frame) {
  const std::uint32_t skipped = state_.gate.numbers_skipped(frame);
  if (skipped == 0) return;
  count(state_.counters.sequence_gaps, skipped == FrameGate::kWentBack ? 1U : skipped);
  report_(EventId::kSequenceSkipped, bits_of(state_.gate.last_sequence_number() + 1U),
          bits_of(frame.sequence_number), bits_of(skipped));
}

// kFrameRefused: the attitude is unsound and must not be reported.
Validity FrameHandler::check_attitude(const gnc::RangeImage& frame) {
  const gnc::AttitudeEstimate& estimate = workspace_.estimate;
  // The estimator returns sound attitudes for any frame and any model. Corrupted memory can break this.
  if (!is_sound(estimate)) {
    state_.faults_seen |= bit_of(Fault::kAttitudeUnsound);
    state_.attitude_check.forget();  // the next attitude is not one period after the last known one
    return Validity::kFrameRefused;
  }
  const bool large = estimate.predicted_error_urad > state_.limit(Limit::kPredictedError_urad);
  const bool jumps = state_.attitude_check.jumps(estimate.q_lrf_trf, state_.limit(Limit::kAttitudeJump_urad));
  const bool repeats = state_.attitude_check.repeats(estimate.q_lrf_trf_single_frame);
  if (large) state_.faults_seen |= bit_of(Fault::kErrorLarge);
  if (jumps) state_.faults_seen |= bit_of(Fault::kAttitudeJump);
  if (repeats) state_.faults_seen |= bit_of(Fault::kFrameFrozen);
  const bool doubtful = large || jumps || repeats;
  if (!doubtful) return Validity::kValid;
  count(state_.counters.attitudes_doubtful);
  report_(EventId::kAttitudeDoubtful, bits_of(frame.sequence_number),
          static_cast<std::int32_t>(estimate.predicted_error_urad / 1000U),
          (jumps ? 1 : 0) + (repeats ? 2 : 0));
  return Validity::kDoubtful;
}

void FrameHandler::report_attitude(const gnc::RangeImage& frame, Validity validity) {
  if (validity == Validity::kFrameRefused) return;
  const gnc::AttitudeEstimate& estimate = workspace_.estimate;
  hal::AttitudeReport& attitude = outputs_.attitude;
  attitude.exposure_time_ns = frame.exposure_time_ns;
  attitude.sequence_number = frame.sequence_number;
  attitude.validity = validity;
  attitude.frames_since_reset = estimate.frames_since_reset;
  attitude.q_lrf_trf = estimate.q_lrf_trf;
  attitude.q_lrf_trf_single_frame = estimate.q_lrf_trf_single_frame;
  attitude.predicted_error_urad = estimate.predicted_error_urad;
  attitude.predicted_error_single_frame_urad = estimate.predicted_error_single_frame_urad;
}

}  // namespace tumblesight::fsw
