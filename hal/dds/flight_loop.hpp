// What the bus thread does while the flight task runs: in lockstep with the simulator, or beside a task on
// its own timer.
#pragma once

#include <cstdint>

#include "hal/dds/flight_bus.hpp"
#include "hal/dds/flight_task.hpp"
#include "hal/dds/idl/flight_end.hpp"

namespace tumblesight::hal::dds {

// Step after step until the last one.
FlightEnd run_lockstep(FlightBus& bus, FlightTask& task);

// A cycle every `period_ns` until the simulator's last step.
FlightEnd run_free(FlightBus& bus, FlightTask& task, Stopwatch& stopwatch, std::int64_t period_ns);

}  // namespace tumblesight::hal::dds
