// Loads the model image that the command line asks for into the flight application.
#pragma once

#include "fsw/app/attitude_init_app.hpp"
#include "hal/dds/flight/flight_options.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal::dds {

// Without a usable image the application stays in STANDBY, and the reason goes to the standard error stream.
void load_model(FlightOptions& options, fsw::AttitudeInitApp& app, Stopwatch& stopwatch);

}  // namespace tumblesight::hal::dds
