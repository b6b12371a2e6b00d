#include "fsw/app/attitude_init_app.hpp"

#include "fsw/app/counter.hpp"
#include "gnc/rcnn/crc32.hpp"

namespace tumblesight::fsw {
namespace {

std::int32_t bits_of(std::uint32_t sequence_number) {
  return static_cast<std::int32_t>(sequence_number);
}

// Within 1e-6.
bool is_unit(const gnc::QuaternionQ30& q) {
  std::int64_t square = 0;  // 28 bits behind the point
  for (const std::int32_t part : q) square += std::int64_t{part} * part >> 32;
  constexpr std::int64_t kOne = std::int64_t{1} << 28;
  constexpr std::int64_t kTolerance = kOne / 500'000;
  return square > kOne - kTolerance && square < kOne + kTolerance;
}

hal::AttitudeReport without_attitude(Validity why) {
  hal::AttitudeReport report;
  report.validity = static_cast<std::uint8_t>(why);
  report.predicted_error_urad = gnc::kPi_urad;
  report.predicted_error_single_frame_urad = gnc::kPi_urad;
  return report;
}

bool is_sound(const gnc::AttitudeEstimate& estimate) {
  return is_unit(estimate.q_lrf_trf) && is_unit(estimate.q_lrf_trf_single_frame) &&
         estimate.predicted_error_urad <= gnc::kPi_urad &&
         estimate.predicted_error_single_frame_urad <= gnc::kPi_urad;
}

// The caller's promises about StepInputs: a platform that breaks them has a bug.
bool keeps_limits(const StepInputs& inputs) {
  const int frames = inputs.frame != nullptr ? inputs.frame_count : 0;
  return inputs.command_count >= 0 && inputs.command_count <= config::kMaxCommandsPerStep && frames >= 0 &&
         frames <= config::kMaxFramesPerStep && inputs.frame_wrong_size >= 0 &&
         inputs.frame_wrong_size <= config::kMaxFramesPerStep &&
         frames + inputs.frame_wrong_size <= config::kMaxFramesPerStep;
}

}  // namespace

template <class N>
void AttitudeInitApp<N>::init(const std::uint8_t* model_image, std::size_t size_bytes,
                           const char* expected_target, hal::Stopwatch& stopwatch) {
  stopwatch_ = &stopwatch;
  model_status_ = estimator_.load(model_image, size_bytes, expected_target);
  model_size_bytes_ = size_bytes < UINT32_MAX ? static_cast<std::uint32_t>(size_bytes) : UINT32_MAX;
  model_to_report_ = true;
  if (model_status_ == gnc::ModelStatus::kOk && mode_ != Mode::kSafe) enter_estimating();
}

template <class N>
void AttitudeInitApp<N>::step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs) {
  const std::uint64_t start_ns = stopwatch_ != nullptr ? stopwatch_->now_ns() : 0;
  static constexpr StepOutputs kNothing{};  // not a temporary one, for which the stack has no room
  outputs = kNothing;
  const std::int64_t previous_ns = has_cycle_ ? now_ns_ : now_ns;
  const bool time_advances = cycle_time_advances(now_ns);
  outputs.attitude = without_attitude(Validity::kStandby);
  count(counters_.cycles);
  if (now_ns < previous_ns) start_anew_in_time();

  report_model(outputs);
  const bool usable = TUMBLESIGHT_ASSERT(assertions_, stopwatch_ != nullptr && keeps_limits(inputs));
  go_safe_on_assertion(outputs);
  if (usable) run_commands(inputs, outputs);

  if (!time_advances) {
    refuse_frames_of_cycle(inputs, elapsed_ms(previous_ns, now_ns), outputs);
  } else if (mode_ == Mode::kEstimating) {
    take_frames(inputs, outputs);
  }
  report_telemetry(start_ns, outputs);
}

template <class N>
void AttitudeInitApp<N>::report(StepOutputs& outputs, EventId id, Severity severity, std::int32_t a,
                             std::int32_t b, std::int32_t c) {
  count(counters_.events);
  if (!TUMBLESIGHT_ASSERT(assertions_, outputs.event_count < config::kMaxEventsPerStep)) return;
  hal::Event& event = outputs.events[static_cast<std::size_t>(outputs.event_count++)];
  event.time_ns = now_ns_;
  event.id = static_cast<std::uint16_t>(id);
  event.severity = static_cast<std::uint8_t>(severity);
  event.arguments = {a, b, c};
}

template <class N>
void AttitudeInitApp<N>::report_model(StepOutputs& outputs) {
  if (!model_to_report_) return;
  model_to_report_ = false;
  const std::int32_t size_bytes = clamp_to_int32(model_size_bytes_);
  if (model_status_ == gnc::ModelStatus::kOk) {
    report(outputs, EventId::kModelActivated, Severity::kInformation, size_bytes,
           static_cast<std::int32_t>(mode_));
  } else {
    report(outputs, EventId::kModelRefused, Severity::kError, static_cast<std::int32_t>(model_status_),
           size_bytes);
  }
}

template <class N>
void AttitudeInitApp<N>::go_safe_on_assertion(StepOutputs& outputs) {
  if (!assertions_.take()) return;
  mode_ = Mode::kSafe;
  report(outputs, EventId::kAssertion, Severity::kError, static_cast<std::int32_t>(assertions_.file()),
         assertions_.line(), clamp_to_int32(assertions_.count()));
}

template <class N>
void AttitudeInitApp<N>::reset_estimator() {
  estimator_.reset();
  count(counters_.estimator_resets);
}

template <class N>
void AttitudeInitApp<N>::enter_estimating() {
  reset_estimator();
  gate_.forget();
  outage_ = false;
  mode_ = Mode::kEstimating;
}

// What is remembered lies in a future that the cycles take long to reach again, if ever: compared with it,
// every frame until then would go backwards.
template <class N>
void AttitudeInitApp<N>::start_anew_in_time() {
  if (mode_ != Mode::kEstimating) return;
  reset_estimator();
  gate_.forget();
}

template <class N>
void AttitudeInitApp<N>::run_commands(const StepInputs& inputs, StepOutputs& outputs) {
  for (int i = 0; i < inputs.command_count; ++i) {
    const hal::Command& command = inputs.commands[static_cast<std::size_t>(i)];
    const auto opcode = static_cast<std::int32_t>(command.opcode);
    CommandRefusal why = CommandRefusal::kUnknownOpcode;
    if (refuses(command, why)) {
      count(counters_.commands_refused);
      report(outputs, EventId::kCommandRefused, Severity::kWarning, opcode, command.payload_size,
             static_cast<std::int32_t>(why));
      continue;
    }
    const Mode before = mode_;
    execute(static_cast<Opcode>(command.opcode));
    count(counters_.commands_accepted);
    report(outputs, EventId::kCommandAccepted, Severity::kInformation, opcode,
           static_cast<std::int32_t>(before), static_cast<std::int32_t>(mode_));
  }
}

template <class N>
bool AttitudeInitApp<N>::refuses(const hal::Command& command, CommandRefusal& why) const {
  const bool known = command.opcode >= static_cast<std::uint16_t>(Opcode::kNoop) &&
                     command.opcode <= static_cast<std::uint16_t>(Opcode::kResetCounters);
  if (!known) {
    why = CommandRefusal::kUnknownOpcode;
    return true;
  }
  if (command.payload_size != 0) {
    why = CommandRefusal::kWrongLength;
    return true;
  }
  if (static_cast<Opcode>(command.opcode) != Opcode::kEstimate) return false;
  why = mode_ == Mode::kSafe ? CommandRefusal::kSafe : CommandRefusal::kNoModel;
  return mode_ == Mode::kSafe || !estimator_.has_model();
}

template <class N>
void AttitudeInitApp<N>::execute(Opcode opcode) {
  switch (opcode) {
    case Opcode::kNoop:
      break;
    case Opcode::kEstimate:
      if (mode_ != Mode::kEstimating) enter_estimating();
      break;
    case Opcode::kStandby:
      mode_ = Mode::kStandby;
      break;
    case Opcode::kResetEstimator:
      reset_estimator();
      break;
    case Opcode::kResetCounters:
      counters_ = hal::Housekeeping{};
      break;
  }
}

template <class N>
bool AttitudeInitApp<N>::cycle_time_advances(std::int64_t now_ns) {
  const bool advances = !has_cycle_ || now_ns > now_ns_;
  has_cycle_ = true;
  now_ns_ = now_ns;
  return advances;
}

template <class N>
void AttitudeInitApp<N>::refuse_frames_of_cycle(const StepInputs& inputs, std::int32_t time_step_ms,
                                             StepOutputs& outputs) {
  std::uint32_t refused = 0;
  if (mode_ == Mode::kEstimating) {
    const int frames = inputs.frame != nullptr ? inputs.frame_count : 0;
    count(counters_.frames_stale, static_cast<std::uint32_t>(frames));
    count(counters_.frames_bad, static_cast<std::uint32_t>(inputs.frame_wrong_size));
    refused = static_cast<std::uint32_t>(frames + inputs.frame_wrong_size);
    count(counters_.frames_refused, refused);
    if (refused == 0) count(counters_.frames_missing);
    outputs.attitude.validity =
        static_cast<std::uint8_t>(refused > 0 ? Validity::kFrameRefused : Validity::kNoFrame);
  }
  report(outputs, EventId::kCycleTimeNotAdvancing, Severity::kError, time_step_ms,
         static_cast<std::int32_t>(refused));
}

template <class N>
void AttitudeInitApp<N>::take_frames(const StepInputs& inputs, StepOutputs& outputs) {
  const int frames = inputs.frame != nullptr ? inputs.frame_count : 0;
  if (frames + inputs.frame_wrong_size == 0) {
    outputs.attitude.validity = static_cast<std::uint8_t>(Validity::kNoFrame);
    count(counters_.frames_missing);
    if (!outage_) {
      report(outputs, EventId::kFrameMissing, Severity::kWarning, bits_of(gate_.last_sequence_number()));
    }
    outage_ = true;
    return;
  }
  outage_ = false;
  outputs.attitude.validity = static_cast<std::uint8_t>(Validity::kFrameRefused);
  for (int i = 0; i < inputs.frame_wrong_size; ++i) {
    count(counters_.frames_refused);
    count(counters_.frames_bad);
    report(outputs, EventId::kFrameWrongSize, Severity::kWarning);
  }
  for (int i = 0; i < frames && !assertions_.pending(); ++i) take_frame(inputs.frame[i], outputs);
}

template <class N>
void AttitudeInitApp<N>::take_frame(const gnc::RangeImage& frame, StepOutputs& outputs) {
  if (passes_gate(frame, outputs)) {
    use_frame(frame, outputs);
  } else {
    count(counters_.frames_refused);
  }
}

template <class N>
bool AttitudeInitApp<N>::passes_gate(const gnc::RangeImage& frame, StepOutputs& outputs) {
  const std::int32_t number = bits_of(frame.sequence_number);
  switch (gate_.judge(frame, now_ns_)) {
    case FrameVerdict::kPass:
      return true;
    case FrameVerdict::kDuplicate:
      count(counters_.frames_duplicate);
      report(outputs, EventId::kFrameDuplicate, Severity::kWarning, number);
      return false;
    case FrameVerdict::kFromFuture:
      count(counters_.frames_stale);
      report(outputs, EventId::kFrameFromFuture, Severity::kWarning, number,
             elapsed_ms(now_ns_, frame.exposure_time_ns));
      return false;
    case FrameVerdict::kExposureBackwards:
      count(counters_.frames_stale);
      report(outputs, EventId::kFrameExposureBackwards, Severity::kWarning, number,
             elapsed_ms(gate_.last_exposure_time_ns(), frame.exposure_time_ns));
      return false;
    case FrameVerdict::kStale:
      count(counters_.frames_stale);
      report(outputs, EventId::kFrameStale, Severity::kWarning, number,
             elapsed_ms(frame.exposure_time_ns, now_ns_));
      return false;
  }
  return false;
}

template <class N>
void AttitudeInitApp<N>::use_frame(const gnc::RangeImage& frame, StepOutputs& outputs) {
  // The reset comes before the step, yet a frame refused for its content must leave the state as it was.
  estimator_.save(state_before_frame_);
  const std::uint32_t frames_before = state_before_frame_.track.frames;
  const bool reset_by_gap = frames_before > 0 && !gate_.one_period_after_last(frame);
  if (reset_by_gap) estimator_.reset();

  const std::uint64_t start_ns = stopwatch_->now_ns();
  const gnc::FrameStatus status = estimator_.step(frame, estimate_);
  if (status != gnc::FrameStatus::kOk) {
    estimator_.restore(state_before_frame_);
    count(counters_.frames_refused);
    count(counters_.frames_bad);
    report(outputs, EventId::kFrameBad, Severity::kWarning, bits_of(frame.sequence_number),
           static_cast<std::int32_t>(status), frame.rays);
    return;
  }
  counters_.inference_us = microseconds_since(start_ns);
  if (counters_.inference_us > counters_.inference_max_us)
    counters_.inference_max_us = counters_.inference_us;

  const std::uint32_t skipped = gate_.numbers_skipped(frame);
  if (skipped > 0) {
    count(counters_.sequence_gaps, skipped == FrameGate::kWentBack ? 1U : skipped);
    report(outputs, EventId::kSequenceSkipped, Severity::kWarning, bits_of(gate_.last_sequence_number() + 1U),
           bits_of(frame.sequence_number), bits_of(skipped));
  }
  if (reset_by_gap) {
    count(counters_.estimator_resets);
    report(outputs, EventId::kEstimatorResetByGap, Severity::kWarning,
           elapsed_ms(gate_.last_exposure_time_ns(), frame.exposure_time_ns), clamp_to_int32(frames_before));
  }
  gate_.accept(frame);
  report_attitude(frame, outputs);
}

template <class N>
void AttitudeInitApp<N>::report_attitude(const gnc::RangeImage& frame, StepOutputs& outputs) {
  // The estimator promises this for any frame and any model it has loaded.
  if (!TUMBLESIGHT_ASSERT(assertions_, is_sound(estimate_))) return;
  count(counters_.frames_used);
  hal::AttitudeReport& attitude = outputs.attitude;
  attitude.exposure_time_ns = frame.exposure_time_ns;
  attitude.sequence_number = frame.sequence_number;
  attitude.validity = static_cast<std::uint8_t>(Validity::kValid);
  attitude.frames_since_reset = estimate_.frames_since_reset;
  attitude.q_lrf_trf = estimate_.q_lrf_trf;
  attitude.q_lrf_trf_single_frame = estimate_.q_lrf_trf_single_frame;
  attitude.predicted_error_urad = estimate_.predicted_error_urad;
  attitude.predicted_error_single_frame_urad = estimate_.predicted_error_single_frame_urad;
}

template <class N>
void AttitudeInitApp<N>::report_telemetry(std::uint64_t start_ns, StepOutputs& outputs) {
  if (stopwatch_ != nullptr) {
    constexpr auto kBudget_us = static_cast<std::uint32_t>(config::kStepBudget_ns / 1000);
    if (microseconds_since(start_ns) > kBudget_us) count(counters_.deadline_overruns);
  }
  go_safe_on_assertion(outputs);
  // What an assertion of this very cycle throws doubt on must not leave it as an attitude.
  if (mode_ == Mode::kSafe) outputs.attitude = without_attitude(Validity::kStandby);
  outputs.attitude.time_ns = now_ns_;
  outputs.housekeeping = counters_;
  outputs.housekeeping.time_ns = now_ns_;
  outputs.housekeeping.mode = static_cast<std::uint8_t>(mode_);
}

// Requires a stopwatch. A stopwatch that runs backwards measures 0.
template <class N>
std::uint32_t AttitudeInitApp<N>::microseconds_since(std::uint64_t start_ns) {
  const std::uint64_t end_ns = stopwatch_->now_ns();
  const std::uint64_t elapsed_us = end_ns > start_ns ? (end_ns - start_ns) / 1000U : 0U;
  return elapsed_us < UINT32_MAX ? static_cast<std::uint32_t>(elapsed_us) : UINT32_MAX;
}

template <class N>
std::uint32_t AttitudeInitApp<N>::state_crc32() const {
  gnc::Crc32 crc;
  crc.add_u32(estimator_.state_crc32());
  crc.add_u32(estimator_.model().crc32);
  crc.add_u32(static_cast<std::uint32_t>(mode_));
  for (const bool flag : {estimator_.has_model(), has_cycle_, gate_.has_last(), outage_, model_to_report_}) {
    crc.add_u32(flag ? 1U : 0U);
  }
  for (const std::int64_t time_ns : {now_ns_, gate_.last_exposure_time_ns()}) {
    crc.add_u32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(time_ns)));
    crc.add_u32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(time_ns) >> 32));
  }
  const hal::Housekeeping& c = counters_;
  for (const std::uint32_t number :
       {gate_.last_sequence_number(), assertions_.count(), c.cycles, c.commands_accepted, c.commands_refused,
        c.frames_used, c.frames_missing, c.frames_refused, c.frames_duplicate, c.frames_stale, c.frames_bad,
        c.sequence_gaps, c.estimator_resets, c.events}) {
    crc.add_u32(number);
  }
  return crc.value();
}

template class AttitudeInitApp<gnc::FixedPoint>;
#if TUMBLESIGHT_FLOAT32
template class AttitudeInitApp<gnc::Float32>;
#endif

}  // namespace tumblesight::fsw
