// Boots the flight application with the model image selected on the command line.
#pragma once

#include "fsw/app/cycle.hpp"
#include "fsw/programs/desktop/flight_options.hpp"
#include "hal/platform.hpp"

namespace tumblesight::fsw::desktop {

// Boots `app` with this platform and the banks of the model image. Without a usable image its mode is SAFE,
// and the reason is written to the standard error stream. If the options or the image ask for float32, the
// fixed-point program replaces itself with flight_float32 from its own folder, with the same arguments
// `argv`. Call it once.
void boot(FlightOptions& options, AttitudeInitApp& app, const hal::Platform& platform, char** argv);

}  // namespace tumblesight::fsw::desktop
