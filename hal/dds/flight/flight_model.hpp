// Loads the model image that the command line asks for into the flight application.
#pragma once

#include "fsw/app/attitude_init_app.hpp"
#include "hal/dds/flight/flight_options.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal::dds {

// The application in either numerics.
struct FlightApps {
  fsw::AttitudeInitApp<gnc::FixedPoint> fixed_point;
  fsw::AttitudeInitApp<gnc::Float32> float32;
};

// The application that flies: the one asked for, or that of the image's numerics. Without a usable image it stays in
// STANDBY, and the reason goes to the standard error stream.
fsw::App& load_model(FlightOptions& options, FlightApps& apps, Stopwatch& stopwatch);

}  // namespace tumblesight::hal::dds
