// Platform: what the flight application uses of the machine beneath it. All of it must outlive the application.
#pragma once

#include "hal/command_key.hpp"
#include "hal/model_store.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal {

struct Platform {
  Stopwatch* stopwatch = nullptr;
  ModelStore* models = nullptr;
  const CommandKey* command_key = nullptr;  // nullptr: the link beneath lets only authentic telecommands through
};

}  // namespace tumblesight::hal
