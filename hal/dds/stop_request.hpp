// SIGTERM and SIGINT as a wish to end, seen by the bus thread whenever it waits.
#pragma once

namespace tumblesight::hal::dds {

void accept_stop_requests();
bool stop_requested();

}  // namespace tumblesight::hal::dds
