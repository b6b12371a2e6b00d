#include "fsw/app/state_keeper.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

StoredState state_to_store(const AppState& state) {
  StoredState wanted;
  wanted.command_counter = state.counters.command_counter;
  wanted.key_slot = state.authority.slot();
  wanted.bank = state.banks.in_use;
  wanted.mode = state.mode;
  wanted.safe_cause = state.counters.safe_cause;
  wanted.safe_fault = state.counters.safe_fault;
  wanted.table = state.table;
  wanted.responses_disabled = state.faults.disabled();
  return wanted;
}

StoreStatus read_copy(hal::PersistentStore& store, int copy, StoredState& stored, std::uint32_t& generation) {
  hal::StoredBytes bytes{};
  const StoreStatus status = store.read(copy, bytes);
  return status == StoreStatus::kOk ? from_record(bytes, stored, generation) : status;
}

}  // namespace

void StateKeeper::resume() {
  Resumption& resumption = state_.resumption;
  if (state_.platform.persistent == nullptr) return;
  for (int copy = 0; copy < hal::kStoredCopies; ++copy) {
    StoredState stored;
    std::uint32_t generation = 0;
    const StoreStatus status = read_copy(*state_.platform.persistent, copy, stored, generation);
    resumption.copies[static_cast<std::size_t>(copy)] = status;
    if (status != StoreStatus::kOk) continue;
    if (generation <= state_.stored.generation) continue;  // the first record has generation 1
    resumption.found = true;
    state_.stored.generation = generation;
    resumption.stored = stored;
  }
  const bool blank =
      resumption.copies[0] == StoreStatus::kBlank && resumption.copies[1] == StoreStatus::kBlank;
  resumption.lost = !resumption.found && !blank;
  if (resumption.found) take(resumption.stored);
}

void StateKeeper::take(const StoredState& stored) {
  state_.counters.command_counter = stored.command_counter;
  state_.table = stored.table;
  for (std::uint8_t fault = 0; fault < kFaults; ++fault) {
    if ((stored.responses_disabled & bit_of(static_cast<Fault>(fault))) != 0)
      (void)state_.faults.enable(fault, false);
  }
  // An empty slot: the platform has other keys than before the reset, and keeps its first one.
  (void)state_.authority.use(stored.key_slot);
}

Cause StateKeeper::boot_cause() const {
  const Resumption& resumption = state_.resumption;
  if (resumption.lost) return Cause::kStoredStateLost;
  if (resumption.stored.mode == Mode::kSafe) return Cause::kResumedSafe;
  const bool abnormal = hal::is_abnormal(state_.platform.reset_cause);
  if (abnormal || resumption.stored.mode == Mode::kStandby) return Cause::kResumedStandby;
  return Cause::kModelFound;
}

void StateKeeper::report_resumption() {
  Resumption& resumption = state_.resumption;
  if (!resumption.to_report) return;
  resumption.to_report = false;
  if (resumption.found) {
    report_(EventId::kStateResumed, static_cast<std::int32_t>(state_.platform.reset_cause),
            static_cast<std::int32_t>(resumption.stored.mode),
            static_cast<std::int32_t>(resumption.stored.bank));
  }
  if (resumption.lost) {
    report_(EventId::kStoredStateLost, static_cast<std::int32_t>(resumption.copies[0]),
            static_cast<std::int32_t>(resumption.copies[1]));
  }
}

int StateKeeper::write_copies(const StoredState& wanted) {
  StoredRecord& record = state_.stored;
  ++record.generation;
  const hal::StoredBytes bytes = to_record(wanted, record.generation);
  int written = 0;
  for (int copy = 0; copy < hal::kStoredCopies; ++copy) {
    if (state_.platform.persistent->write(copy, bytes) == StoreStatus::kOk) ++written;
  }
  if (written > 0) record.last = wanted;
  const bool fails = written < hal::kStoredCopies;
  if (fails) count(state_.counters.state_writes_failed);
  if (fails && !record.failing) report_(EventId::kStateNotStored, written);
  record.failing = fails;
  return written;
}

bool StateKeeper::store_counter() {
  if (state_.platform.persistent == nullptr) return true;
  return write_copies(state_to_store(state_)) > 0;
}

void StateKeeper::store_changes() {
  if (state_.platform.persistent == nullptr) return;
  const StoredState wanted = state_to_store(state_);
  if (state_.stored.failing || wanted != state_.stored.last) (void)write_copies(wanted);
}

}  // namespace tumblesight::fsw
