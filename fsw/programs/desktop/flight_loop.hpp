// What the bus thread does while the flight task runs: in lockstep with the simulator, or beside a task on
// its own timer.
#pragma once

#include <cstdint>

#include "fsw/programs/desktop/flight_task.hpp"
#include "hal/dds/flight_bus.hpp"
#include "hal/dds/idl/flight_end.hpp"

namespace tumblesight::hal::dds {

// Both take a task that has been started, return once it has ended, and report on the standard error stream
// what the last telemetry could not tell. A run that was complete but for the heap ends with kHeapUsed.

// Step after step until the last one.
FlightEnd run_lockstep(FlightBus& bus, FlightTask& task);

// A cycle every `period_ns` until the simulator's last step.
FlightEnd run_free(FlightBus& bus, FlightTask& task, Stopwatch& stopwatch, std::int64_t period_ns);

}  // namespace tumblesight::hal::dds
