// The work of the bus thread while the flight task runs: it exchanges samples between DDS and the task,
// either in lockstep with the simulator or beside a task on its own timer.
#pragma once

#include <cstdint>

#include "fsw/programs/desktop/flight_task.hpp"
#include "hal/dds/flight_bus.hpp"
#include "hal/dds/idl/flight_end.hpp"

namespace tumblesight::fsw::desktop {

// Both functions need a task that has been started, and return after it has ended. They report slips and heap
// use on the standard error stream, since telemetry cannot report what happens after the last cycle. A
// complete run in which the flight task used the heap returns kHeapUsed.

// Runs one cycle per step of the simulator until its last step.
hal::dds::FlightEnd exchange_in_lockstep(hal::dds::FlightBus& bus, FlightTask& task);

// Lets the task run a cycle every `period_ns` of wall-clock time until the simulator's last step.
hal::dds::FlightEnd exchange_free_running(hal::dds::FlightBus& bus, FlightTask& task,
                                          hal::Stopwatch& stopwatch, std::int64_t period_ns);

}  // namespace tumblesight::fsw::desktop
