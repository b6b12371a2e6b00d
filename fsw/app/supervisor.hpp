// Supervisor: measures the step, watches how long faults persist, and carries out the responses.
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

  // After the frames. `validity`: of this cycle's attitude; `start_ns`: when the step began, by the
  // stopwatch; `resets_before`: the count of estimator resets after the commands.
  void supervise(Validity validity, std::uint32_t cycle_slips, std::uint64_t start_ns,
                 std::uint32_t resets_before);

 private:
  void measure(std::uint64_t start_ns);
  void observe(Fault fault);
  void respond(const config::FaultRule& rule);

  AppState& state_;
  ModeManager& modes_;
  ModelManager& models_;
  const Reporter& report_;
};

}  // namespace tumblesight::fsw
