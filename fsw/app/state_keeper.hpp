// StateKeeper: stores what must survive a reset, and resumes from it at boot. It lives for one step;
// everything that it keeps is in AppState.
//
// Both copies of the store hold the newest record, one written after the other, so that a reset during a
// write leaves one intact record, and a later bit flip in one copy does no harm. The copy that holds the
// newest record is written last, also after several resets in a row. A write is read back. Every
// kStoreCheck_cycles both copies are read again. A copy that does not hold the newest record is rewritten in
// every cycle for kMostFailingCycles cycles, then with each new record and at each check.
//
// The store is given up when no copy could be written in kMostFailingCycles consecutive cycles. The
// application then works as if there were no store, so that the ground can command it, and tries again at
// each check. Until a try succeeds, a change that a reset would undo is reported.
//
// At boot the counter is the highest one of all good heads (stored_state.hpp), and the key slot that of the
// newest good head. Everything else is that of the newest good body.
//
// The mode after a reset:
//   stored                 normal reset    abnormal reset (hal::is_abnormal)
//   nothing                RUN             STANDBY
//   RUN                    RUN             STANDBY
//   STANDBY                STANDBY         STANDBY
//   SAFE                   SAFE            SAFE
//   lost, even in part     SAFE            SAFE
// Without a good model it is SAFE.
#pragma once

#include <cstdint>

#include "fsw/app/app_state.hpp"

namespace tumblesight::fsw {

class StateKeeper {
 public:
  StateKeeper(AppState& state, const Reporter& report);

  // At boot: takes counter, key slot, table and disabled responses from the good copies. What is lost has
  // its initial value; the key slot is then the lowest one with a key. The result is kept in
  // AppState::resumption.
  void resume();
  // Why the first mode after boot is what it is, if a good model was found.
  Cause boot_cause() const;
  // In the first step after boot: reports the result of resume(). If no copy had a good head, it reads both
  // again and resumes what can be read, except for mode and bank.
  void report_resumption();

  // Writes a new record now. False: no copy could be written. True without a store, or with one that was
  // given up.
  [[nodiscard]] bool store_now();
  // At the end of a step: stores what has changed, and rewrites a copy that could not be written or was
  // corrupted in the store. Measures its time.
  void end_step();
  StoreHealth health() const;

 private:
  void take(const StoredState& stored);
  void resume_late();
  bool is_check_due();
  void store_changes();
  bool holds(int copy, const hal::StoredBytes& bytes) const;
  bool put(int copy, const hal::StoredBytes& bytes);
  int first_to_write() const;
  void write_record(const StoredState& wanted);
  void renew_copies();
  void settle(StoredCopies good);
  void judge_store();
  void report_unstored_change();

  AppState& state_;
  const Reporter& report_;
  const StoredState before_;  // at the beginning of the step
};

}  // namespace tumblesight::fsw
