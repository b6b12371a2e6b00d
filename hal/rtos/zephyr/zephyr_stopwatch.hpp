// ZephyrStopwatch: the time since Zephyr started, in whole ticks. It never goes back.
#pragma once

#include <zephyr/kernel.h>

#include "hal/stopwatch.hpp"

namespace tumblesight::hal::rtos {

class ZephyrStopwatch final : public Stopwatch {
 public:
  std::uint64_t now_ns() override {
    return k_ticks_to_ns_floor64(static_cast<std::uint64_t>(k_uptime_ticks()));
  }
};

}  // namespace tumblesight::hal::rtos
