// Platform: what the flight application uses from the machine that it runs on. All pointers must stay valid
// as long as the application.
#pragma once

#include <cstdint>

#include "hal/messages/command_key.hpp"
#include "hal/model_store.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal {

struct Platform {
  Stopwatch* stopwatch = nullptr;
  ModelStore* models = nullptr;
  // nullptr: the link delivers authentic telecommands only, without a security trailer.
  const CommandKey* command_key = nullptr;
  // Telemetry::command_counter from before the restart; 0: none. If the platform does not keep it, old
  // telecommands can be replayed after a restart.
  std::uint32_t last_command_counter = 0;
};

}  // namespace tumblesight::hal
