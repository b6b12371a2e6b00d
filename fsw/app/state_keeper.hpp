// StateKeeper: stores what must survive a reset, and resumes from it at boot. It lives for one step;
// everything that it keeps is in AppState.
//
// Both copies of the store hold the newest record, one written after the other, so that a reset during a
// write leaves a whole record and a later bit flip in one copy costs nothing. A failed copy is written again
// in every cycle until it succeeds.
//
// The mode after a reset:
//   stored            normal reset    abnormal reset (hal::is_abnormal)
//   nothing           RUN             STANDBY
//   RUN               RUN             STANDBY
//   STANDBY           STANDBY         STANDBY
//   SAFE              SAFE            SAFE
//   both copies bad   SAFE            SAFE        cold boot: counter 0, key slot 0, initial table, bank 0
// Without a good model it is SAFE.
#pragma once

#include <cstdint>

#include "fsw/app/app_state.hpp"

namespace tumblesight::fsw {

class StateKeeper {
 public:
  StateKeeper(AppState& state, const Reporter& report) : state_(state), report_(report) {}

  // At boot: takes counter, key slot, table and disabled responses from the newest good copy. The result is
  // kept in AppState::resumption.
  void resume();
  // The cause of the first mode, if a good model was found.
  Cause boot_cause() const;
  // Reports the result of resume() once, in the first step after it.
  void report_resumption();

  // Before a command is carried out. False: no copy could be written.
  [[nodiscard]] bool store_counter();
  // At the end of a step: stores what has changed.
  void store_changes();

 private:
  void take(const StoredState& stored);
  int write_copies(const StoredState& wanted);

  AppState& state_;
  const Reporter& report_;
};

}  // namespace tumblesight::fsw
