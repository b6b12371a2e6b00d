#include "fsw/app/attitude_init_app.hpp"

#include "fsw/app/counter.hpp"
#include "gnc/numerics/crc32.hpp"

namespace tumblesight::fsw {
namespace {

hal::AttitudeReport without_attitude(Validity why) {
  hal::AttitudeReport report;
  report.validity = static_cast<std::uint8_t>(why);
  report.predicted_error_urad = gnc::kPi_urad;
  report.predicted_error_single_frame_urad = gnc::kPi_urad;
  return report;
}

bool is_within(int count, int most) {
  return count >= 0 && count <= most;
}

// The caller's promises about StepInputs: a platform that breaks them has a bug.
bool keeps_limits(const StepInputs& inputs) {
  const int frames = inputs.frame != nullptr ? inputs.frame_count : 0;
  return is_within(inputs.command_count, config::kMaxCommandsPerStep) &&
         is_within(frames, config::kMaxFramesPerStep) &&
         is_within(inputs.frame_wrong_size, config::kMaxFramesPerStep - frames);
}

bool is_complete(const hal::Platform& platform) {
  return platform.stopwatch != nullptr && platform.models != nullptr;
}

}  // namespace

template <class N>
void AttitudeInitApp<N>::init(const hal::Platform& platform, const char* expected_target,
                              Protections protections) {
  *state_ = AppState{};
  events_ = EventLog{};
  state_->platform = platform;
  state_->counters.command_counter = platform.last_command_counter;
  state_->expected_target = expected_target;
  state_->protections = protections;
  for (std::size_t i = 0; i < config::kLimitRules.size(); ++i)
    state_->limits[i] = config::kLimitRules[i].initial;
  estimator_.reset();
  if (TUMBLESIGHT_ASSERT(state_->assertions, is_complete(platform))) {
    for (std::uint32_t bank = 0; bank < hal::kModelBanks; ++bank) boot_from(bank);
    enter(state_->has_model() ? Cause::kModelFound : Cause::kNoModel);
    state_->boot_to_report = true;
  }
  guard_.keep(estimator_, *state_);
  state_.commit();
}

// The first good image is activated, another one kept as second copy or to fall back on.
template <class N>
void AttitudeInitApp<N>::boot_from(std::uint32_t bank) {
  const hal::ModelBank memory = state_->platform.models->bank(static_cast<int>(bank));
  ModelBankRecord& record = state_->banks.record[bank];
  record.size_bytes = static_cast<std::uint32_t>(memory.size < UINT32_MAX ? memory.size : UINT32_MAX);
  gnc::ModelStatus& status = state_->boot_status[bank];
  if (!state_->has_model()) {
    status = activate(bank);
    return;
  }
  status = estimator_.check(memory.data, memory.size, state_->expected_target);
  if (status != gnc::ModelStatus::kOk) return;
  record.status = static_cast<std::uint32_t>(BankStatus::kGood);
  record.crc32 = gnc::model_image_crc32(memory.data);
}

// The image of `bank`, of the size that its record tells; it is checked whole. On any other status than kOk
// the model before stays in use.
template <class N>
gnc::ModelStatus AttitudeInitApp<N>::activate(std::uint32_t bank) {
  ModelBankRecord& record = state_->banks.record[bank];
  const std::uint8_t* const image = state_->platform.models->bank(static_cast<int>(bank)).data;
  const gnc::ModelStatus status = estimator_.load(image, record.size_bytes, state_->expected_target);
  if (status != gnc::ModelStatus::kOk) {
    record.status = static_cast<std::uint32_t>(BankStatus::kEmpty);
    return status;
  }
  record.status = static_cast<std::uint32_t>(BankStatus::kGood);
  record.crc32 = estimator_.model().crc32;
  state_->banks.in_use = bank;
  state_->attitude_check.forget();
  guard_.model_activated(estimator_, *state_);
  return status;
}

template <class N>
void AttitudeInitApp<N>::step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs) {
  const std::uint32_t corrected = state_->protections.memory ? state_.vote() : 0;
  AppState& state = *state_;
  const Reporter report(state, events_);
  const bool usable =
      TUMBLESIGHT_ASSERT(state.assertions, is_complete(state.platform) && keeps_limits(inputs));
  const std::uint64_t start_ns = usable ? state.platform.stopwatch->now_ns() : 0;
  outputs.event_count = 0;
  outputs.has_dump = false;
  outputs.duties_done = false;
  outputs.attitude = without_attitude(Validity::kStandby);
  const std::int64_t previous_ns = state.has_cycle ? state.now_ns : now_ns;
  const bool time_advances = cycle_time_advances(now_ns);
  count(state.counters.cycles);
  state.faults_seen = 0;

  if (corrected > 0) {
    count(state.counters.memory_corrections, corrected);
    report(EventId::kMemoryCorrected, clamp_to_int32(corrected));
  }
  report_boot(report);
  go_safe_on_assertion(report);
  if (usable) {
    if (state.protections.memory) guard_.check(estimator_, state, report);
    if (now_ns < previous_ns) start_anew_in_time();
    run_commands(inputs, outputs, report);
    if (!time_advances) {
      refuse_frames_of_cycle(inputs, elapsed_ms(previous_ns, now_ns), outputs, report);
    } else if (state.mode == Mode::kRun) {
      take_frames(inputs, outputs, report);
    }
    supervise(inputs, outputs, start_ns, report);
  }
  go_safe_on_assertion(report);
  report_telemetry(outputs);
  guard_.keep(estimator_, state);
  state_.commit();
  outputs.duties_done = usable;
}

// True if the table has such a transition.
template <class N>
bool AttitudeInitApp<N>::enter(Cause cause, Fault fault) {
  const Mode before = state_->mode;
  if (!next_mode(before, cause, state_->mode)) return false;
  if (state_->mode == Mode::kRun && before != Mode::kRun) {
    reset_estimator();
    state_->gate.forget();
    state_->outage = false;
  }
  if (state_->mode == Mode::kSafe && before != Mode::kSafe) {
    state_->counters.safe_cause = static_cast<std::uint8_t>(cause);
    state_->counters.safe_fault = static_cast<std::uint8_t>(fault);
  }
  return true;
}

template <class N>
void AttitudeInitApp<N>::reset_estimator() {
  estimator_.reset();
  state_->attitude_check.forget();
  count(state_->counters.estimator_resets);
}

template <class N>
void AttitudeInitApp<N>::report_boot(const Reporter& report) {
  if (!state_->boot_to_report) return;
  state_->boot_to_report = false;
  for (std::uint32_t bank = 0; bank < hal::kModelBanks; ++bank) {
    const auto size_bytes = clamp_to_int32(state_->banks.record[bank].size_bytes);
    const gnc::ModelStatus status = state_->boot_status[bank];
    // An empty second bank is no error where the first one is good.
    const bool needed = bank == 0 || size_bytes > 0, good = status == gnc::ModelStatus::kOk;
    if (good && bank == state_->banks.in_use) {
      report(EventId::kModelActivated, size_bytes, static_cast<std::int32_t>(bank));
    } else if (!good && needed) {
      report(EventId::kModelRefused, static_cast<std::int32_t>(status), size_bytes,
             static_cast<std::int32_t>(bank));
    }
  }
  if (state_->mode == Mode::kSafe) report(EventId::kSafeEntered, state_->counters.safe_cause, -1);
}

template <class N>
void AttitudeInitApp<N>::go_safe_on_assertion(const Reporter& report) {
  AssertionLog& assertions = state_->assertions;
  if (!assertions.take()) return;
  enter(Cause::kAssertion);
  report(EventId::kAssertion, static_cast<std::int32_t>(assertions.file()), assertions.line(),
         clamp_to_int32(assertions.count()));
}

template <class N>
bool AttitudeInitApp<N>::cycle_time_advances(std::int64_t now_ns) {
  const bool advances = !state_->has_cycle || now_ns > state_->now_ns;
  state_->has_cycle = true;
  state_->now_ns = now_ns;
  return advances;
}

// What is remembered lies in a future that the cycles take long to reach again, if ever: compared with it,
// every frame until then would go backwards.
template <class N>
void AttitudeInitApp<N>::start_anew_in_time() {
  if (state_->mode != Mode::kRun) return;
  reset_estimator();
  state_->gate.forget();
}

template <class N>
void AttitudeInitApp<N>::supervise(const StepInputs& inputs, const StepOutputs& outputs,
                                   std::uint64_t start_ns, const Reporter& report) {
  AppState& state = *state_;
  const auto validity = static_cast<Validity>(outputs.attitude.validity);
  const bool has_attitude = validity == Validity::kValid || validity == Validity::kDoubtful;
  if (state.mode == Mode::kRun && !has_attitude) state.faults_seen |= bit_of(Fault::kOutage);
  if (inputs.cycle_slips > 0) {
    count(state.counters.cycle_slips, inputs.cycle_slips);
    state.faults_seen |= bit_of(Fault::kSlip);
    report(EventId::kCycleSlipped, clamp_to_int32(inputs.cycle_slips));
  }
  measure(start_ns, report);
  for (int i = 0; i < kFaults; ++i) {
    const auto fault = static_cast<Fault>(i);
    const FaultMonitor::Change change = state.faults.observe(fault, (state.faults_seen & bit_of(fault)) != 0);
    if (change == FaultMonitor::Change::kPersists) respond(fault, report);
    if (change == FaultMonitor::Change::kOver) {
      report(is_of_timing(fault) ? EventId::kTimingFaultOver : EventId::kFaultOver, i);
    }
  }
}

template <class N>
void AttitudeInitApp<N>::measure(std::uint64_t start_ns, const Reporter& report) {
  constexpr std::array<std::uint32_t, hal::Housekeeping::kStepTimeBins - 1> kEdges_us{
      1'000, 3'000, 10'000, 30'000, 100'000, 300'000, 1'000'000};
  hal::Housekeeping& counters = state_->counters;
  counters.step_us = microseconds_since(start_ns);
  if (counters.step_us > counters.step_max_us) counters.step_max_us = counters.step_us;
  std::size_t bin = 0;
  for (const std::uint32_t edge_us : kEdges_us) bin += counters.step_us >= edge_us ? 1 : 0;
  count(counters.steps_by_time[bin]);
  if (counters.step_us <= state_->limit(Limit::kStepBudget_us)) return;
  count(counters.deadline_overruns);
  state_->faults_seen |= bit_of(Fault::kDeadline);
  report(EventId::kDeadlineOverrun, static_cast<std::int32_t>(counters.step_us / 1000U));
}

template <class N>
void AttitudeInitApp<N>::respond(Fault fault, const Reporter& report) {
  AppState& state = *state_;
  const Response response = state.faults.response_to(fault);
  Response taken = response;
  switch (response) {
    case Response::kIgnore:
    case Response::kFlag:
      break;
    case Response::kResetSequence:
      report(EventId::kEstimatorResetByFault, static_cast<std::int32_t>(fault));
      reset_estimator();
      break;
    case Response::kSwitchBank:
      taken = switch_bank(fault, report);
      break;
    case Response::kSafe:
      go_safe(fault, report);
      break;
  }
  if (response == Response::kIgnore) return;
  const EventId id = is_of_timing(fault) ? EventId::kTimingFaultPersists : EventId::kFaultPersists;
  const config::FaultRule& rule = config::kFaultRules[static_cast<std::size_t>(fault)];
  report(id, static_cast<std::int32_t>(fault), static_cast<std::int32_t>(taken), rule.persistence_cycles);
}

// What it came to: the switch, nothing where there is a good model again, or SAFE where the other bank holds
// no good model.
template <class N>
Response AttitudeInitApp<N>::switch_bank(Fault fault, const Reporter& report) {
  if (state_->has_model()) return Response::kFlag;  // a command of this cycle has activated it
  const std::uint32_t before = state_->banks.in_use, other = state_->banks.other();
  if (state_->banks.status(other) == BankStatus::kGood && activate(other) == gnc::ModelStatus::kOk) {
    count(state_->counters.bank_switches);
    report(EventId::kBankSwitched, static_cast<std::int32_t>(before), static_cast<std::int32_t>(other));
    return Response::kSwitchBank;
  }
  go_safe(fault, report);
  return Response::kSafe;
}

template <class N>
void AttitudeInitApp<N>::go_safe(Fault fault, const Reporter& report) {
  if (!enter(Cause::kFault, fault)) return;
  report(EventId::kSafeEntered, static_cast<std::int32_t>(Cause::kFault), static_cast<std::int32_t>(fault));
}

template <class N>
void AttitudeInitApp<N>::report_telemetry(StepOutputs& outputs) {
  AppState& state = *state_;
  // What a fault or assertion of this very cycle throws doubt on must not leave it as an attitude.
  if (state.mode != Mode::kRun) outputs.attitude = without_attitude(Validity::kStandby);
  outputs.attitude.time_ns = state.now_ns;

  hal::Housekeeping& counters = state.counters;
  events_.end_cycle(state.now_ns, counters);
  while (outputs.event_count < config::kMaxEventsPerStep &&
         events_.take(outputs.events[static_cast<std::size_t>(outputs.event_count)])) {
    ++outputs.event_count;
  }
  counters.time_ns = state.now_ns;
  counters.mode = static_cast<std::uint8_t>(state.mode);
  counters.faults_persisting = state.faults.persisting();
  counters.responses_disabled = state.faults.disabled();
  counters.events_waiting = events_.waiting();
  if (counters.events_waiting > counters.events_waiting_max)
    counters.events_waiting_max = counters.events_waiting;
  counters.bank_in_use = static_cast<std::uint8_t>(state.banks.in_use);
  counters.second_copy = state.banks.has_second_copy() ? 1 : 0;
  counters.model_bytes_loaded = state.banks.loaded_bytes;
  for (std::size_t bank = 0; bank < hal::kModelBanks; ++bank) {
    counters.bank_status[bank] = static_cast<std::uint8_t>(state.banks.record[bank].status);
    counters.bank_crc32[bank] = state.banks.record[bank].crc32;
  }
  outputs.housekeeping = counters;
}

// A stopwatch that runs backwards measures 0.
template <class N>
std::uint32_t AttitudeInitApp<N>::microseconds_since(std::uint64_t start_ns) const {
  const std::uint64_t end_ns = state_->platform.stopwatch->now_ns();
  const std::uint64_t elapsed_us = end_ns > start_ns ? (end_ns - start_ns) / 1000U : 0U;
  return elapsed_us < UINT32_MAX ? static_cast<std::uint32_t>(elapsed_us) : UINT32_MAX;
}

template <class N>
std::uint32_t AttitudeInitApp<N>::state_crc32() const {
  const AppState& state = *state_.operator->();
  gnc::Crc32 crc;
  const auto add_time = [&crc](std::int64_t time_ns) {
    crc.add_u32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(time_ns)));
    crc.add_u32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(time_ns) >> 32));
  };
  crc.add_u32(estimator_.state_crc32());
  crc.add_u32(estimator_.model().crc32);
  crc.add_u32(static_cast<std::uint32_t>(state.mode));
  for (const bool flag :
       {state.has_model(), state.has_cycle, state.gate.has_last(), state.outage, state.boot_to_report}) {
    crc.add_u32(flag ? 1U : 0U);
  }
  add_time(state.now_ns);
  add_time(state.gate.last_exposure_time_ns());
  for (const std::uint32_t limit : state.limits) crc.add_u32(limit);
  const hal::Housekeeping& c = state.counters;
  for (const std::uint32_t number :
       {state.gate.last_sequence_number(),
        state.assertions.count(),
        c.command_counter,
        state.faults.persisting() & ~(bit_of(Fault::kDeadline) | bit_of(Fault::kSlip)),
        state.faults.disabled(),
        state.banks.in_use,
        state.banks.loaded_bytes,
        c.cycles,
        c.commands_accepted,
        c.commands_refused,
        c.frames_used,
        c.frames_missing,
        c.frames_refused,
        c.frames_duplicate,
        c.frames_stale,
        c.frames_bad,
        c.sequence_gaps,
        c.estimator_resets,
        c.attitudes_doubtful,
        c.model_passes}) {
    crc.add_u32(number);
  }
  return crc.value();
}

// Of the members that are defined here; the others: attitude_init_app_commands.cpp,
// attitude_init_app_frames.cpp.
template class AttitudeInitApp<gnc::FixedPoint>;
#if TUMBLESIGHT_FLOAT32
template class AttitudeInitApp<gnc::Float32>;
#endif

}  // namespace tumblesight::fsw
