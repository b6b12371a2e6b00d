#include "fsw/app/attitude_init_app.hpp"

#include "fsw/app/command_handler.hpp"
#include "fsw/app/counter.hpp"
#include "fsw/app/state_digest.hpp"
#include "fsw/app/state_keeper.hpp"
#include "fsw/app/supervisor.hpp"

namespace tumblesight::fsw {
namespace {

hal::AttitudeReport without_attitude(Validity why) {
  hal::AttitudeReport report;
  report.validity = why;
  report.predicted_error_urad = gnc::kPi_urad;
  report.predicted_error_single_frame_urad = gnc::kPi_urad;
  return report;
}

bool is_within(int count, int most) {
  return count >= 0 && count <= most;
}

// The limits that the caller promises to keep.
bool keeps_limits(const StepInputs& inputs) {
  return is_within(inputs.command_count, config::kMaxCommandsPerStep) &&
         is_within(inputs.dropped_count, config::kMaxDeliveriesPerCycle) &&
         is_within(inputs.frame_wrong_size, config::kMaxDeliveriesPerCycle) &&
         is_within(inputs.deliveries(), config::kMaxDeliveriesPerCycle);
}

bool is_complete(const hal::Platform& platform) {
  return platform.stopwatch != nullptr && platform.models != nullptr;
}

void clear(StepOutputs& outputs) {
  outputs.event_count = 0;
  outputs.has_dump = false;
  outputs.duties_done = false;
  outputs.attitude = without_attitude(Validity::kStandby);
}

// Begins a cycle. True: its time is later than that of the previous one.
bool begin_cycle(AppState& state, std::int64_t now_ns) {
  const bool time_advances = !state.has_cycle || now_ns > state.now_ns;
  state.has_cycle = true;
  state.now_ns = now_ns;
  state.faults_seen = 0;
  state.long_task = false;
  count(state.counters.cycles);
  return time_advances;
}

void report_corrections(std::uint32_t corrected_words, AppState& state, const Reporter& report) {
  count(corrected_words, state.words_corrected);
  state.words_corrected = 0;
  if (corrected_words == 0) return;
  count(state.counters.memory_corrections, corrected_words);
  report(EventId::kMemoryCorrected, clamp_to_int32(corrected_words));
}

// The telemetry that is not a counter.
void fill_telemetry(AppState& state) {
  hal::Telemetry& telemetry = state.counters;
  telemetry.time_ns = state.now_ns;
  telemetry.mode = state.mode;
  telemetry.faults_persisting = state.faults.persisting();
  telemetry.responses_disabled = state.faults.disabled();
  telemetry.events_waiting = state.events.waiting();
  if (telemetry.events_waiting > telemetry.events_waiting_max)
    telemetry.events_waiting_max = telemetry.events_waiting;
  telemetry.bank_in_use = static_cast<std::uint8_t>(state.banks.in_use);
  telemetry.key_slot = static_cast<std::uint8_t>(state.authority.slot());
  telemetry.second_copy = state.banks.has_second_copy() ? 1 : 0;
  telemetry.long_task = state.long_task ? 1 : 0;
  telemetry.model_segments_missing = state.banks.segments_missing;
  telemetry.table_status = state.loaded_table.status;
  telemetry.table_crc32 = crc32_of(state.table);
  for (std::uint32_t bank = 0; bank < hal::kModelBanks; ++bank) {
    telemetry.bank_status[bank] = state.banks.status(bank);
    telemetry.bank_crc32[bank] = state.banks.descriptor[bank].crc32;
  }
  if (state.platform.models == nullptr) return;
  for (int bank = 0; bank < hal::kModelBanks; ++bank)
    telemetry.bank_activity[static_cast<std::size_t>(bank)] = state.platform.models->activity(bank);
}

}  // namespace

void AttitudeInitApp::init(const hal::Platform& platform, const char* expected_target) {
  state_.restart();
  AppState& state = *state_;
  const Reporter report(state, state.events);
  ModeManager modes(state, estimator_, report);
  state.platform = platform;
  state.platform.command_keys = nullptr;
  state.authority.set(platform.command_keys, platform.command_apid);
  state.expected_target.set(expected_target);
  estimator_.reset();
  if (TUMBLESIGHT_ASSERT(state.assertions, is_complete(platform))) {
    StateKeeper keeper(state, report);
    keeper.resume();
    ModelManager(state, estimator_, scrubber_, report).boot(state.resumption.stored.bank);
    modes.resume(state.has_model() ? keeper.boot_cause() : Cause::kNoModel, state.resumption.stored);
    state.boot_to_report = true;
    state.resumption.to_report = true;
  }
  scrubber_.keep(estimator_, state);
  state_.commit();
}

void AttitudeInitApp::correct_state() {
  const std::uint32_t corrected_words = state_.vote();
  if (corrected_words == 0) return;
  count(state_->words_corrected, corrected_words);
  state_.commit();
}

bool AttitudeInitApp::use(const ParameterTable& table) {
  if (first_wrong_field(table) < kTableFields) return false;
  correct_state();
  AppState& state = *state_;
  if (table.fields != state.table.fields) state.stored.has_unstored_change = true;
  state.table = table;
  state.table_is_given = true;
  state_.commit();
  return true;
}

void AttitudeInitApp::step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs) {
  step_with(now_ns, inputs, outputs, Protections::kOn);
}

void AttitudeInitApp::step_with(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs,
                                Protections protections) {
  const bool with_protections = protections == Protections::kOn;
  const std::uint32_t corrected_words = with_protections ? state_.vote() : 0;
  AppState& state = *state_;
  const Reporter report(state, state.events);
  ModeManager modes(state, estimator_, report);
  ModelManager models(state, estimator_, scrubber_, report);
  const bool usable =
      TUMBLESIGHT_ASSERT(state.assertions, is_complete(state.platform) && keeps_limits(inputs));
  const std::int64_t previous_ns = state.has_cycle ? state.now_ns : now_ns;
  const bool time_advances = begin_cycle(state, now_ns);
  clear(outputs);

  report_corrections(corrected_words, state, report);
  StateKeeper keeper(state, report);
  keeper.report_resumption();
  models.report_boot();
  modes.go_safe_on_assertion();
  if (usable) {
    if (with_protections) {
      if (!MemoryScrubber::bound(estimator_, state)) modes.go_safe_after_corruption();
      scrubber_.check(estimator_, state, report);
    }
    if (now_ns < previous_ns) modes.restart_sequence_after_time_jump();
    CommandHandler({state, state.events, modes, models, keeper, outputs, report}).run(inputs);
    const std::uint32_t resets_before = state.counters.estimator_resets;
    take_frames(inputs, previous_ns, time_advances, outputs, report);
    if (!state.long_task) models.continue_copy();
    Supervisor(state, modes, models, report)
        .supervise(outputs.attitude.validity, inputs.cycle_slips, inputs.timing.previous_us, resets_before);
  }
  modes.go_safe_on_assertion();
  // Also if the inputs were refused: a reset must not undo the SAFE that follows.
  if (is_complete(state.platform)) keeper.end_step();
  state.counters.store_health = keeper.health();
  report_telemetry(outputs);
  scrubber_.keep(estimator_, state);
  state_.commit();
  outputs.duties_done = usable;
}

void AttitudeInitApp::take_frames(const StepInputs& inputs, std::int64_t previous_ns, bool time_advances,
                                  StepOutputs& outputs, const Reporter& report) {
  FrameHandler frames(*state_, estimator_, frame_workspace_, outputs, report);
  if (!time_advances) {
    frames.refuse_all(inputs, elapsed_ms(previous_ns, state_->now_ns));
  } else if (state_->mode == Mode::kRun) {
    frames.take(inputs);
  }
}

void AttitudeInitApp::report_telemetry(StepOutputs& outputs) {
  AppState& state = *state_;
  // A fault or an assertion of this cycle may make its attitude untrustworthy.
  if (state.mode != Mode::kRun) outputs.attitude = without_attitude(Validity::kStandby);
  outputs.attitude.time_ns = state.now_ns;

  EventLog& events = state.events;
  events.end_cycle(state.now_ns, state.event_limits(), state.counters);
  while (outputs.event_count < config::kMaxEventsPerStep &&
         events.take(outputs.events[static_cast<std::size_t>(outputs.event_count)])) {
    ++outputs.event_count;
  }
  fill_telemetry(state);
  outputs.telemetry = state.counters;
}

gnc::FrameVerdict AttitudeInitApp::judge(const gnc::RangeImage& frame, std::int64_t now_ns) const {
  return state_->tracking.gate.judge(frame, now_ns, state_->time_limits());
}

std::uint32_t AttitudeInitApp::state_crc32() const {
  return digest_of(*state_.operator->(), estimator_);
}

}  // namespace tumblesight::fsw
