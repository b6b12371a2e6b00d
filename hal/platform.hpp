// Platform: what the flight application uses of the machine beneath it. All of it must outlive the
// application.
#pragma once

#include <cstdint>

#include "hal/command_key.hpp"
#include "hal/model_store.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal {

struct Platform {
  Stopwatch* stopwatch = nullptr;
  ModelStore* models = nullptr;
  const CommandKey* command_key =
      nullptr;  // nullptr: the link beneath lets only authentic telecommands through
  // Of the last telecommand before the start, from the housekeeping that the platform has kept; 0: none. What
  // it does not keep can be replayed after a restart.
  std::uint32_t last_command_counter = 0;
};

}  // namespace tumblesight::hal
