// The way of a frame: gate, estimator, checks of the attitude, report.
#include "fsw/app/attitude_init_app.hpp"
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

template <class N>
void AttitudeInitApp<N>::refuse_frames_of_cycle(const StepInputs& inputs, std::int32_t time_step_ms,
                                                StepOutputs& outputs, const Reporter& report) {
  std::uint32_t refused = 0;
  if (state_->mode == Mode::kRun) {
    hal::Housekeeping& counters = state_->counters;
    const int frames = inputs.frame != nullptr ? inputs.frame_count : 0;
    count(counters.frames_stale, static_cast<std::uint32_t>(frames));
    count(counters.frames_bad, static_cast<std::uint32_t>(inputs.frame_wrong_size));
    refused = static_cast<std::uint32_t>(frames + inputs.frame_wrong_size);
    count(counters.frames_refused, refused);
    if (refused == 0) count(counters.frames_missing);
    outputs.attitude.validity =
        static_cast<std::uint8_t>(refused > 0 ? Validity::kFrameRefused : Validity::kNoFrame);
  }
  report(EventId::kCycleTimeNotAdvancing, time_step_ms, static_cast<std::int32_t>(refused));
}

template <class N>
void AttitudeInitApp<N>::take_frames(const StepInputs& inputs, StepOutputs& outputs, const Reporter& report) {
  const int frames = inputs.frame != nullptr ? inputs.frame_count : 0;
  if (frames + inputs.frame_wrong_size == 0) {
    outputs.attitude.validity = static_cast<std::uint8_t>(Validity::kNoFrame);
    count(state_->counters.frames_missing);
    if (!state_->outage) report(EventId::kFrameMissing, bits_of(state_->gate.last_sequence_number()));
    state_->outage = true;
    return;
  }
  state_->outage = false;
  outputs.attitude.validity = static_cast<std::uint8_t>(Validity::kFrameRefused);
  for (int i = 0; i < inputs.frame_wrong_size; ++i) {
    count(state_->counters.frames_refused);
    count(state_->counters.frames_bad);
    report(EventId::kFrameWrongSize);
  }
  for (int i = 0; i < frames; ++i) take_frame(inputs.frame[i], outputs, report);
}

// There is no model in the cycle that has lost it; the response to that comes after the frames.
template <class N>
void AttitudeInitApp<N>::take_frame(const gnc::RangeImage& frame, StepOutputs& outputs,
                                    const Reporter& report) {
  if (state_->has_model() && passes_gate(frame, report)) {
    use_frame(frame, outputs, report);
  } else {
    count(state_->counters.frames_refused);
  }
}

template <class N>
bool AttitudeInitApp<N>::passes_gate(const gnc::RangeImage& frame, const Reporter& report) {
  hal::Housekeeping& counters = state_->counters;
  const std::int32_t number = bits_of(frame.sequence_number);
  switch (state_->gate.judge(frame, state_->now_ns)) {
    case FrameVerdict::kPass:
      return true;
    case FrameVerdict::kDuplicate:
      count(counters.frames_duplicate);
      report(EventId::kFrameDuplicate, number);
      return false;
    case FrameVerdict::kFromFuture:
      count(counters.frames_stale);
      report(EventId::kFrameFromFuture, number, elapsed_ms(state_->now_ns, frame.exposure_time_ns));
      return false;
    case FrameVerdict::kExposureBackwards:
      count(counters.frames_stale);
      report(EventId::kFrameExposureBackwards, number,
             elapsed_ms(state_->gate.last_exposure_time_ns(), frame.exposure_time_ns));
      return false;
    case FrameVerdict::kStale:
      count(counters.frames_stale);
      report(EventId::kFrameStale, number, elapsed_ms(frame.exposure_time_ns, state_->now_ns));
      return false;
  }
  return false;
}

template <class N>
void AttitudeInitApp<N>::use_frame(const gnc::RangeImage& frame, StepOutputs& outputs,
                                   const Reporter& report) {
  // The reset comes before the step, yet a frame refused for its content must leave the state as it was.
  estimator_.save(state_before_frame_);
  const std::uint32_t frames_before = state_before_frame_.track.frames;
  const bool reset_by_gap = frames_before > 0 && !state_->gate.one_period_after_last(frame);
  if (reset_by_gap) estimator_.reset();

  hal::Housekeeping& counters = state_->counters;
  const std::uint64_t start_ns = state_->platform.stopwatch->now_ns();
  const gnc::FrameStatus status = estimator_.step(frame, estimate_);
  if (status != gnc::FrameStatus::kOk) {
    estimator_.restore(state_before_frame_);
    count(counters.frames_refused);
    count(counters.frames_bad);
    report(EventId::kFrameBad, bits_of(frame.sequence_number), static_cast<std::int32_t>(status), frame.rays);
    return;
  }
  counters.inference_us = microseconds_since(start_ns);
  if (counters.inference_us > counters.inference_max_us) counters.inference_max_us = counters.inference_us;

  FrameGate& gate = state_->gate;
  const std::uint32_t skipped = gate.numbers_skipped(frame);
  if (skipped > 0) {
    count(counters.sequence_gaps, skipped == FrameGate::kWentBack ? 1U : skipped);
    report(EventId::kSequenceSkipped, bits_of(gate.last_sequence_number() + 1U),
           bits_of(frame.sequence_number), bits_of(skipped));
  }
  if (reset_by_gap) {
    count(counters.estimator_resets);
    state_->attitude_check.forget();
    report(EventId::kEstimatorResetByGap, elapsed_ms(gate.last_exposure_time_ns(), frame.exposure_time_ns),
           clamp_to_int32(frames_before));
  }
  gate.accept(frame);
  count(counters.frames_used);
  report_attitude(frame, outputs, report);
}

template <class N>
void AttitudeInitApp<N>::report_attitude(const gnc::RangeImage& frame, StepOutputs& outputs,
                                         const Reporter& report) {
  AppState& state = *state_;
  Validity validity = Validity::kValid;
  if (state.protections.attitude) {
    // The estimator promises it for any frame and any model; memory that has been hit may break the promise.
    if (!is_sound(estimate_)) {
      state.faults_seen |= bit_of(Fault::kAttitudeUnsound);
      state.attitude_check.forget();  // the next attitude is not one period after the last one known
      return;
    }
    const bool large = estimate_.predicted_error_urad > state.limit(Limit::kPredictedError_urad);
    const bool jumps =
        state.attitude_check.jumps(estimate_.q_lrf_trf, state.limit(Limit::kAttitudeJump_urad));
    const bool repeats = state.attitude_check.repeats(estimate_.q_lrf_trf_single_frame);
    if (large) state.faults_seen |= bit_of(Fault::kErrorLarge);
    if (jumps) state.faults_seen |= bit_of(Fault::kAttitudeJump);
    if (repeats) state.faults_seen |= bit_of(Fault::kFrameFrozen);
    if (large || jumps || repeats) {
      validity = Validity::kDoubtful;
      count(state.counters.attitudes_doubtful);
      report(EventId::kAttitudeDoubtful, bits_of(frame.sequence_number),
             static_cast<std::int32_t>(estimate_.predicted_error_urad / 1000U),
             (jumps ? 1 : 0) + (repeats ? 2 : 0));
    }
  }
  hal::AttitudeReport& attitude = outputs.attitude;
  attitude.exposure_time_ns = frame.exposure_time_ns;
  attitude.sequence_number = frame.sequence_number;
  attitude.validity = static_cast<std::uint8_t>(validity);
  attitude.frames_since_reset = estimate_.frames_since_reset;
  attitude.q_lrf_trf = estimate_.q_lrf_trf;
  attitude.q_lrf_trf_single_frame = estimate_.q_lrf_trf_single_frame;
  attitude.predicted_error_urad = estimate_.predicted_error_urad;
  attitude.predicted_error_single_frame_urad = estimate_.predicted_error_single_frame_urad;
}

#define TUMBLESIGHT_INSTANTIATE(N)                                                                        \
  template void AttitudeInitApp<N>::refuse_frames_of_cycle(const StepInputs&, std::int32_t, StepOutputs&, \
                                                           const Reporter&);                              \
  template void AttitudeInitApp<N>::take_frames(const StepInputs&, StepOutputs&, const Reporter&)

TUMBLESIGHT_INSTANTIATE(gnc::FixedPoint);
#if TUMBLESIGHT_FLOAT32
TUMBLESIGHT_INSTANTIATE(gnc::Float32);
#endif

}  // namespace tumblesight::fsw
