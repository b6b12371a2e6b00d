// SIGTERM and SIGINT as a request to stop. The bus thread checks it whenever it waits.
#pragma once

namespace tumblesight::hal::dds {

// Installs the signal handlers.
void accept_stop_requests();
bool stop_requested();

}  // namespace tumblesight::hal::dds
