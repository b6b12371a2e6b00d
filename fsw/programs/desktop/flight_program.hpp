// The two desktop flight programs: `flight` in fixed point and `flight_float32`. A user starts `flight`,
// which replaces itself with flight_float32 for float32.
#pragma once

#include <cstddef>
#include <type_traits>

#include "fsw/config/numerics.hpp"
#include "hal/dds/idl/flight_end.hpp"

namespace tumblesight::fsw::desktop {

inline constexpr bool kFlyFloat32 = std::is_same_v<fsw::Numerics, gnc::Float32>;
inline constexpr const char* kProgramName = kFlyFloat32 ? "flight_float32" : "flight";

// The folder of this program, without a slash at its end. Returns false if it is unknown or longer than
// `size`.
[[nodiscard]] bool program_folder(char* folder, std::size_t size);

// Replaces this program with flight_float32 of its own folder, with the same arguments `argv`. Returns only
// if that program cannot be started: the reason and the remedy are written to the standard error stream. Call
// it before anything that the other program cannot do again, such as reading a pipe or handling a signal.
hal::dds::FlightEnd become_float32_program(char** argv);

}  // namespace tumblesight::fsw::desktop
