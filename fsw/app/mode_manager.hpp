// ModeManager: changes the mode by the transition table, and resets the estimator where a new sequence
// begins. It lives for one step; everything that it keeps is in AppState.
#pragma once

#include "fsw/app/app_state.hpp"

namespace tumblesight::fsw {

class ModeManager {
 public:
  ModeManager(AppState& state, Estimator& estimator, const Reporter& report)
      : state_(state), estimator_(estimator), report_(report) {}

  // Changes the mode by the transition for `cause`. On entering RUN the estimator is reset and the last frame
  // is forgotten. On entering SAFE the telemetry records cause and fault. False: the table has no such
  // transition.
  bool enter(Cause cause, Fault fault = Fault::kStateLost);
  // At boot: enters the first mode. If the stored mode is SAFE, the telemetry keeps its cause and fault.
  void resume(Cause cause, const StoredState& stored);
  // Enters SAFE because of a fault, with an event. No effect in a mode without such a transition.
  void go_safe(Fault fault);
  // Enters SAFE from any mode, and also from a value that is no mode. For a state so corrupted that the vote
  // cannot repair it.
  void go_safe_after_corruption();
  // Enters SAFE, with an event, if an assertion has failed since the last call.
  void go_safe_on_assertion();
  // The next frame is the first of a new sequence. Counted.
  void reset_estimator();
  // Call after the cycle time has gone back. The last frame then lies in the future, and the gate would
  // refuse every frame until that time. Forgets the last frame and resets the estimator.
  void restart_sequence_after_time_jump();

 private:
  AppState& state_;
  Estimator& estimator_;
  const Reporter& report_;
};

}  // namespace tumblesight::fsw
