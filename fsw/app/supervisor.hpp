// Supervisor: watches how long cycles take and how long faults persist, and carries out the responses.
#pragma once

#include <cstdint>

#include "fsw/app/app_state.hpp"
#include "fsw/app/mode_manager.hpp"
#include "fsw/app/model_manager.hpp"
#include "fsw/app/step_io.hpp"

namespace tumblesight::fsw {

class Supervisor {
 public:
  Supervisor(AppState& state, ModeManager& modes, ModelManager& models, const Reporter& report)
      : state_(state), modes_(modes), models_(models), report_(report) {}

  // After the frames. `validity`: of this cycle's attitude; `previous_cycle_us`: that the previous cycle
  // took, or 0; `resets_before`: the count of estimator resets after the commands.
  void supervise(Validity validity, std::uint32_t cycle_slips, std::uint32_t previous_cycle_us,
                 std::uint32_t resets_before);

 private:
  void note_duration(std::uint32_t cycle_us);  // of the previous cycle
  void observe(Fault fault);
  void respond(const config::FaultRule& rule);

  AppState& state_;
  ModeManager& modes_;
  ModelManager& models_;
  const Reporter& report_;
};

}  // namespace tumblesight::fsw
