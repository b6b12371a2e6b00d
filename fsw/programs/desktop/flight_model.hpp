// Boots the flight application with the model image that the command line asks for.
#pragma once

#include "fsw/app/cycle.hpp"
#include "fsw/programs/desktop/flight_options.hpp"
#include "hal/command_key.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::hal::dds {

// The application in either numerics.
struct FlightApps {
  fsw::AttitudeInitApp<gnc::FixedPoint> fixed_point;
  fsw::AttitudeInitApp<gnc::Float32> float32;
  fsw::AppOf<gnc::FixedPoint> fixed_point_interface{fixed_point};
  fsw::AppOf<gnc::Float32> float32_interface{float32};
};

// Boots the application that flies: the one asked for, or that of the image's numerics. Without a usable
// image its mode is SAFE, and the reason goes to the standard error stream.
fsw::App& boot(FlightOptions& options, FlightApps& apps, Stopwatch& stopwatch, const CommandKey& command_key);

}  // namespace tumblesight::hal::dds
