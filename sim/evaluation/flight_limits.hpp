// The limits of the tracker in the flight program after init(). sim/ does not know fsw/: a test compares them
// with fsw/config.
#pragma once

#include "gnc/estimation/frame_tracker.hpp"

namespace tumblesight::sim {

inline constexpr gnc::FrameTrackerLimits kFlightLimits{
    {1'000'000, 2'970'000'000}, 21'600'000'000, 8'100'000'000, 10'000'000, 523'599, 1'047'198};

}  // namespace tumblesight::sim
