// Boots the flight application with the model image selected on the command line.
#pragma once

#include "fsw/app/cycle.hpp"
#include "fsw/programs/desktop/flight_options.hpp"
#include "hal/command_key.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::fsw::desktop {

// The application in either numerics.
struct FlightApps {
  fsw::AttitudeInitApp<gnc::FixedPoint> fixed_point;
  fsw::AttitudeInitApp<gnc::Float32> float32;
  fsw::AppOf<gnc::FixedPoint> fixed_point_interface{fixed_point};
  fsw::AppOf<gnc::Float32> float32_interface{float32};
};

// Boots the application of the requested numerics, or of the image's numerics if none are requested, and
// returns it. Without a usable image its mode is SAFE, and the reason is written to the standard error
// stream. Call it once.
fsw::App& boot(FlightOptions& options, FlightApps& apps, hal::Stopwatch& stopwatch,
               const hal::CommandKey& command_key);

}  // namespace tumblesight::fsw::desktop
