// The colours of estimators and conditions, the same in every figure.
#pragma once

#include "sim/world/scenario/sequence.hpp"

namespace tumblesight::sim {

inline constexpr const char* kRcnnColour = "#1b5e9e";
inline constexpr const char* kCnnColour = "#d0702a";
inline constexpr const char* kBaselineColour = "#7b8794";
inline constexpr const char* kPaperColour = "#c3c9d1";

const char* colour_of(Condition condition);

}  // namespace tumblesight::sim
