#include "fsw/app/supervisor.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {

void Supervisor::supervise(Validity validity, std::uint32_t cycle_slips, std::uint32_t previous_cycle_us,
                           std::uint32_t resets_before) {
  const bool has_attitude = validity == Validity::kValid || validity == Validity::kDoubtful;
  if (state_.mode == Mode::kRun && !has_attitude) state_.faults_seen |= bit_of(Fault::kOutage);
  if (cycle_slips > 0) {
    count(state_.counters.cycle_slips, cycle_slips);
    state_.faults_seen |= bit_of(Fault::kSlip);
    report_(EventId::kCycleSlipped, clamp_to_int32(cycle_slips));
  }
  note_duration(previous_cycle_us);
  constexpr int kLast = static_cast<int>(Fault::kTrackRestarts);
  static_assert(kLast == kFaults - 1, "behind the faults whose responses reset the estimator");
  for (int i = 0; i < kLast; ++i) observe(static_cast<Fault>(i));
  if (state_.counters.estimator_resets != resets_before) state_.faults_seen |= bit_of(Fault::kTrackRestarts);
  observe(Fault::kTrackRestarts);
}

void Supervisor::observe(Fault fault) {
  const bool present = (state_.faults_seen & bit_of(fault)) != 0;
  // A model is lost in one cycle and stays lost until a good one is activated.
  if (!present && fault == Fault::kModelCorrupted && !state_.has_model()) {
    state_.faults.hold(fault);
    return;
  }
  const config::FaultRule rule = state_.table.rule_of(fault);
  const FaultMonitor::Change change = state_.faults.observe(rule, present);
  if (change == FaultMonitor::Change::kPersists) respond(rule);
  if (change == FaultMonitor::Change::kOver) {
    report_(is_of_timing(fault) ? EventId::kTimingFaultOver : EventId::kFaultOver,
            static_cast<std::int32_t>(fault));
  }
}

void Supervisor::note_duration(std::uint32_t cycle_us) {
  constexpr std::array<std::uint32_t, hal::Telemetry::kCycleTimeBins - 1> kEdges_us{
      1'000, 3'000, 10'000, 30'000, 100'000, 300'000, 1'000'000};
  hal::Telemetry& counters = state_.counters;
  counters.cycle_us = cycle_us;
  if (cycle_us == 0) return;  // not measured
  if (cycle_us > counters.cycle_max_us) counters.cycle_max_us = cycle_us;
  std::size_t bin = 0;
  for (const std::uint32_t edge_us : kEdges_us) bin += cycle_us >= edge_us ? 1 : 0;
  count(counters.cycles_by_time[bin]);
  if (cycle_us <= state_.table[Parameter::kCycleBudget_us]) return;
  count(counters.deadline_overruns);
  state_.faults_seen |= bit_of(Fault::kDeadline);
  report_(EventId::kDeadlineOverrun, static_cast<std::int32_t>(cycle_us / 1000U));
}

void Supervisor::respond(const config::FaultRule& rule) {
  const Fault fault = rule.fault;
  const Response response = state_.faults.response_to(rule);
  Response taken = response;
  switch (response) {
    case Response::kIgnore:
      return;
    case Response::kFlag:
      break;
    case Response::kResetSequence:
      report_(EventId::kEstimatorResetByFault, static_cast<std::int32_t>(fault));
      modes_.reset_estimator();
      break;
    case Response::kSwitchBank:
      taken = models_.switch_bank(fault, modes_);
      break;
    case Response::kSafe:
      modes_.go_safe(fault);
      break;
  }
  const EventId id = is_of_timing(fault) ? EventId::kTimingFaultPersists : EventId::kFaultPersists;
  report_(id, static_cast<std::int32_t>(fault), static_cast<std::int32_t>(taken), rule.cycles);
}

}  // namespace tumblesight::fsw
