// SIGTERM and SIGINT as a request to stop. The bus thread checks it whenever it waits.
#pragma once

#include "hal/dds/idl/flight_end.hpp"

namespace tumblesight::hal::dds {

// Installs the signal handlers.
void accept_stop_requests();
bool stop_requested();
// With a request: kInterrupted or kTerminated, by the latest signal.
FlightEnd stop_reason();

}  // namespace tumblesight::hal::dds
