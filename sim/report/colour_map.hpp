// A sequential colour map for depth: dark blue through teal to pale yellow, rising evenly in lightness, so
// that it also reads in grey print.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::sim {

using Rgb = std::array<std::uint8_t, 3>;

// `value` in 0..1, clamped.
Rgb sequential_colour(double value);

}  // namespace tumblesight::sim
