#include "fsw/app/state_keeper.hpp"

#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

using hal::kStoredCopies;
using hal::StateLoss;

constexpr std::uint32_t bit_of(StateLoss loss) {
  return static_cast<std::uint32_t>(loss);
}

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

// A read can be disturbed, so it is repeated until the record is good. `generation` is 0 without a good head.
StoreStatus read_copy(hal::PersistentStore& store, int copy, StoredState& stored, std::uint32_t& generation) {
  StoreStatus status = StoreStatus::kFailed;
  for (int i = 0; i < config::kStoreReads; ++i) {
    hal::StoredBytes bytes{};
    stored = {};
    generation = 0;
    status = store.read(copy, bytes);
    if (status == StoreStatus::kOk) status = from_record(bytes, stored, generation);
    if (status == StoreStatus::kOk || status == StoreStatus::kBlank) break;
  }
  return status;
}

// What the copies hold together.
class Survey {
 public:
  void add(int copy, StoreStatus status, const StoredState& stored, std::uint32_t generation) {
    if (status == StoreStatus::kBlank) ++blank_;
    if (stored.command_counter > head_.command_counter) head_.command_counter = stored.command_counter;
    if (generation > newest_) {
      newest_ = generation;
      newest_head_copy_ = copy;
      head_.key_slot = stored.key_slot;
    }
    if (!has_body(status) || generation <= newest_body_) return;  // the first record has generation 1
    newest_body_ = generation;
    newest_body_copy_ = copy;
    body_ = stored;
    table_known_ = status == StoreStatus::kOk;
  }

  // Counter and slot of the heads, all else of the newest body.
  StoredState state() const {
    StoredState result = body_;
    result.command_counter = head_.command_counter;
    result.key_slot = head_.key_slot;
    return result;
  }
  std::uint32_t newest() const { return newest_; }
  bool found() const { return newest_body_ > 0; }
  // The copy that can be overwritten first: a reset during that write then loses nothing.
  int first_copy() const { return kStoredCopies - 1 - (found() ? newest_body_copy_ : newest_head_copy_); }
  // A sum of StateLoss. A torn write leaves a body that is one generation old.
  std::uint32_t lost() const {
    if (blank_ == kStoredCopies) return 0;
    if (newest_ == 0) return bit_of(StateLoss::kHead) | bit_of(StateLoss::kBody);
    if (newest_body_ == 0) return bit_of(StateLoss::kBody);
    return (table_known_ ? 0 : bit_of(StateLoss::kTable)) |
           (newest_ - newest_body_ <= 1 ? 0 : bit_of(StateLoss::kStale));
  }

 private:
  StoredState head_, body_;
  std::uint32_t newest_ = 0;       // generation of the heads
  std::uint32_t newest_body_ = 0;  // generation
  int newest_head_copy_ = kStoredCopies - 1;
  int newest_body_copy_ = kStoredCopies - 1;
  int blank_ = 0;
  bool table_known_ = true;
};

}  // namespace

StateKeeper::StateKeeper(AppState& state, const Reporter& report)
    : state_(state), report_(report), before_(state_to_store(state)) {}

void StateKeeper::resume() {
  Resumption& resumption = state_.resumption;
  if (state_.platform.persistent == nullptr) return;
  Survey survey;
  for (int copy = 0; copy < kStoredCopies; ++copy) {
    StoredState stored;
    std::uint32_t generation = 0;
    const StoreStatus status = read_copy(*state_.platform.persistent, copy, stored, generation);
    resumption.copies[static_cast<std::size_t>(copy)] = status;
    survey.add(copy, status, stored, generation);
  }
  state_.stored.generation = survey.newest();
  resumption.first_copy = static_cast<std::uint8_t>(survey.first_copy());
  resumption.found = survey.found();
  resumption.lost = survey.lost();
  resumption.stored = survey.state();
  if (survey.newest() > 0) take(resumption.stored);
}

void StateKeeper::take(const StoredState& stored) {
  state_.counters.command_counter = stored.command_counter;
  if (!state_.table_is_given) state_.table = stored.table;
  for (std::uint8_t fault = 0; fault < kFaults; ++fault) {
    if ((stored.responses_disabled & bit_of(static_cast<Fault>(fault))) != 0)
      (void)state_.faults.enable(fault, false);
  }
  if (state_.authority.keys() == nullptr || state_.authority.use(stored.key_slot)) return;
  state_.resumption.lost |= bit_of(StateLoss::kKeySlot);
}

Cause StateKeeper::boot_cause() const {
  const Resumption& resumption = state_.resumption;
  if (resumption.lost != 0) return Cause::kStoredStateLost;
  if (resumption.stored.mode == Mode::kSafe) return Cause::kResumedSafe;
  const bool abnormal = hal::is_abnormal(state_.platform.reset_cause);
  if (abnormal || resumption.stored.mode == Mode::kStandby) return Cause::kResumedStandby;
  return Cause::kModelFound;
}

// Memory may need some time after power-on. Mode and bank are decided at boot and stay.
void StateKeeper::resume_late() {
  Resumption& resumption = state_.resumption;
  if ((resumption.lost & bit_of(StateLoss::kHead)) == 0) return;
  resume();
  resumption.found = false;
  if ((resumption.lost & bit_of(StateLoss::kBody)) == 0) resumption.lost |= bit_of(StateLoss::kModeAndBank);
}

void StateKeeper::report_resumption() {
  Resumption& resumption = state_.resumption;
  if (!resumption.to_report) return;
  resumption.to_report = false;
  resume_late();
  if (resumption.found) {
    report_(EventId::kStateResumed, static_cast<std::int32_t>(state_.platform.reset_cause),
            static_cast<std::int32_t>(resumption.stored.mode),
            static_cast<std::int32_t>(resumption.stored.bank));
  }
  const auto first = static_cast<std::int32_t>(resumption.copies[0]);
  const auto second = static_cast<std::int32_t>(resumption.copies[1]);
  if (resumption.lost != 0) {
    report_(EventId::kStoredStateLost, first, second, static_cast<std::int32_t>(resumption.lost));
  } else if (resumption.copies != decltype(resumption.copies){}) {
    report_(EventId::kStoredCopyUnusable, first, second);
  }
}

bool StateKeeper::holds(int copy, const hal::StoredBytes& bytes) const {
  hal::StoredBytes read{};
  if (state_.platform.persistent->read(copy, read) != StoreStatus::kOk) return false;
  return read == bytes;
}

bool StateKeeper::put(int copy, const hal::StoredBytes& bytes) {
  return state_.platform.persistent->write(copy, bytes) == StoreStatus::kOk && holds(copy, bytes);
}

// The copy to write first: one that does not hold the newest record, if there is such a copy.
int StateKeeper::first_to_write() const {
  const StoredCopies good = state_.stored.good;
  if (good.number() == 1) return good.has(0) ? 1 : 0;
  return state_.resumption.first_copy;
}

void StateKeeper::write_record(const StoredState& wanted) {
  StoredRecord& record = state_.stored;
  ++record.generation;
  record.last = wanted;
  const hal::StoredBytes bytes = to_record(wanted, record.generation);
  const int first = first_to_write();
  StoredCopies good;
  for (const int copy : {first, kStoredCopies - 1 - first}) good.set(copy, put(copy, bytes));
  settle(good);
}

// A good copy is not written, which would wear it out.
void StateKeeper::renew_copies() {
  const StoredRecord& record = state_.stored;
  const hal::StoredBytes bytes = to_record(record.last, record.generation);
  StoredCopies good = record.good;
  for (int copy = 0; copy < kStoredCopies; ++copy) {
    if (good.has(copy)) good.set(copy, holds(copy, bytes));
  }
  if (good.number() < record.good.number()) settle(good);
  const int first = first_to_write();
  for (const int copy : {first, kStoredCopies - 1 - first}) {
    if (!good.has(copy)) good.set(copy, put(copy, bytes));
  }
  settle(good);
}

void StateKeeper::settle(StoredCopies good) {
  StoredRecord& record = state_.stored;
  const std::uint32_t before = record.good.number(), now = good.number();
  if (now < kStoredCopies) count(state_.counters.state_writes_failed);
  if (now < before) report_(EventId::kStateNotStored, static_cast<std::int32_t>(now));
  if (now != before) record.failing_cycles = 0;
  record.good = good;
}

bool StateKeeper::store_now() {
  if (state_.platform.persistent == nullptr || state_.stored.given_up) return true;
  write_record(state_to_store(state_));
  return state_.stored.good.number() > 0;
}

bool StateKeeper::is_check_due() {
  std::uint32_t& cycles = state_.stored.cycles_since_check;
  if (++cycles < config::kStoreCheck_cycles) return false;
  cycles = 0;
  return true;
}

void StateKeeper::store_changes() {
  const StoredRecord& record = state_.stored;
  const bool due = is_check_due();
  if (record.given_up && !due) return;
  const StoredState wanted = state_to_store(state_);
  if (wanted != record.last) {
    write_record(wanted);
  } else if (due ||
             (record.good.number() < kStoredCopies && record.failing_cycles < config::kMostFailingCycles)) {
    renew_copies();
  }
  judge_store();
}

void StateKeeper::judge_store() {
  StoredRecord& record = state_.stored;
  record.failing_cycles = record.good.number() < kStoredCopies ? record.failing_cycles + 1 : 0;
  if (record.good.number() > 0) {
    if (record.given_up) report_(EventId::kStoreUsable, static_cast<std::int32_t>(record.good.number()));
    record.given_up = false;
  } else if (record.failing_cycles == config::kMostFailingCycles) {
    record.given_up = true;
    count(state_.counters.store_given_up);
    report_(EventId::kStoreGivenUp, static_cast<std::int32_t>(record.failing_cycles));
  }
}

void StateKeeper::report_unstored_change() {
  StoredRecord& record = state_.stored;
  StoredState now = state_to_store(state_);
  now.command_counter = before_.command_counter;  // each command changes it
  if (now != before_) record.has_unstored_change = true;
  if (record.good.number() > 0) record.has_unstored_change = false;
  if (!record.given_up || !record.has_unstored_change) return;
  record.has_unstored_change = false;
  report_(EventId::kChangeNotStored, static_cast<std::int32_t>(now.key_slot),
          static_cast<std::int32_t>(now.mode), static_cast<std::int32_t>(now.bank));
}

void StateKeeper::end_step() {
  if (state_.platform.persistent == nullptr) return;
  hal::Telemetry& counters = state_.counters;
  const std::uint64_t start_ns = state_.platform.stopwatch->now_ns();
  store_changes();
  report_unstored_change();
  counters.store_us = elapsed_us(start_ns, state_.platform.stopwatch->now_ns());
  if (counters.store_us > counters.store_max_us) counters.store_max_us = counters.store_us;
}

StoreHealth StateKeeper::health() const {
  const StoredRecord& record = state_.stored;
  if (state_.platform.persistent == nullptr) return StoreHealth::kNone;
  if (record.given_up) return StoreHealth::kGivenUp;
  if (record.good.number() == 0) return StoreHealth::kFailing;
  return record.good.number() < kStoredCopies ? StoreHealth::kOneCopy : StoreHealth::kGood;
}

}  // namespace tumblesight::fsw
