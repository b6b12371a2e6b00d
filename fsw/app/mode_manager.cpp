#include "fsw/app/mode_manager.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {

bool ModeManager::enter(Cause cause, Fault fault) {
  const Mode before = state_.mode;
  if (!next_mode(before, cause, state_.mode)) return false;
  if (state_.mode == Mode::kRun && before != Mode::kRun) {
    reset_estimator();
    state_.tracking.forget_times();
    state_.outage = false;
  }
  if (state_.mode == Mode::kSafe && before != Mode::kSafe) {
    state_.counters.safe_cause = cause;
    state_.counters.safe_fault = fault;
  }
  return true;
}

void ModeManager::resume(Cause cause, const StoredState& stored) {
  enter(cause);
  if (cause != Cause::kResumedSafe) return;
  state_.counters.safe_cause = stored.safe_cause;
  state_.counters.safe_fault = stored.safe_fault;
}

void ModeManager::go_safe(Fault fault) {
  if (!enter(Cause::kFault, fault)) return;
  report_(EventId::kSafeEntered, static_cast<std::int32_t>(Cause::kFault), static_cast<std::int32_t>(fault));
}

void ModeManager::go_safe_after_corruption() {
  state_.mode = Mode::kSafe;
  state_.counters.safe_cause = Cause::kFault;
  state_.counters.safe_fault = Fault::kStateLost;
  state_.faults_seen |= bit_of(Fault::kStateLost);
  report_(EventId::kSafeEntered, static_cast<std::int32_t>(Cause::kFault),
          static_cast<std::int32_t>(Fault::kStateLost));
}

void ModeManager::go_safe_on_assertion() {
  AssertionLog& assertions = state_.assertions;
  if (!assertions.take()) return;
  enter(Cause::kAssertion);
  report_(EventId::kAssertion, static_cast<std::int32_t>(assertions.file()), assertions.line(),
          clamp_to_int32(assertions.count()));
}

void ModeManager::reset_estimator() {
  estimator_.reset();
  state_.tracking.forget_track();
  count(state_.counters.estimator_resets);
}

void ModeManager::restart_sequence_after_time_jump() {
  if (state_.mode != Mode::kRun) return;
  reset_estimator();
  state_.faults_seen |= bit_of(Fault::kTrackRestarts);
  state_.tracking.forget_times();
}

}  // namespace tumblesight::fsw
