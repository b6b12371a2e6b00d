// RtemsStopwatch: the time since RTEMS started. It never goes back, unlike the time of day.
#pragma once

#include <rtems.h>

#include "hal/stopwatch.hpp"

namespace tumblesight::hal::rtos {

class RtemsStopwatch final : public Stopwatch {
 public:
  std::uint64_t now_ns() override { return rtems_clock_get_uptime_nanoseconds(); }
};

}  // namespace tumblesight::hal::rtos
