// Colours of figures and pictures.
#pragma once

#include <array>
#include <cstdint>

#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

// The colours of estimators and conditions, the same in every figure.
inline constexpr const char* kRcnnColour = "#1b5e9e";
inline constexpr const char* kCnnColour = "#d0702a";
inline constexpr const char* kPoseColour = "#3a8a3f";
inline constexpr const char* kDoubtfulPoseColour = "#b83227";
inline constexpr const char* kBaselineColour = "#7b8794";
inline constexpr const char* kPaperColour = "#c3c9d1";

const char* colour_of(Condition condition);

// A sequential colour map for depth, from dark blue through teal to pale yellow. Its lightness rises evenly,
// so that it also works in grey print.
using Rgb = std::array<std::uint8_t, 3>;

// `value` is clamped to 0..1.
Rgb sequential_colour(double value);

}  // namespace tumblesight::sim
