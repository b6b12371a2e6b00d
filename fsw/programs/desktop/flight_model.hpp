// The model image selected on the command line, and the boot of the flight application with it.
#pragma once

#include "fsw/app/cycle.hpp"
#include "fsw/programs/desktop/flight_options.hpp"
#include "hal/platform.hpp"
#include "hal/posix/file_model_store.hpp"

namespace tumblesight::fsw::desktop {

// Reads the image of options.model_path. If that is empty, it becomes the path of the shipped image. Call it
// once.
hal::posix::FileModelStore& open_model(FlightOptions& options);

// Whether the options or, without --numerics, the image ask for float32.
bool wants_float32(const FlightOptions& options, hal::ModelStore& store);

// Boots `app` on this platform, whose models are `store`. Without a usable image its mode is SAFE, and the
// reason is written to the standard error stream.
void boot(const FlightOptions& options, AttitudeInitApp& app, const hal::Platform& platform,
          hal::posix::FileModelStore& store);

}  // namespace tumblesight::fsw::desktop
