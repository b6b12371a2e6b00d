// A sequential colour map for depth, from dark blue through teal to pale yellow. Its lightness rises evenly,
// so that it also works in grey print.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::sim {

using Rgb = std::array<std::uint8_t, 3>;

// `value` is clamped to 0..1.
Rgb sequential_colour(double value);

}  // namespace tumblesight::sim
