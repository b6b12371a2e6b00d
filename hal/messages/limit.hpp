// Limits that SET_LIMIT can change. The numbers are part of the interface (docs/icd.md);
// fsw/config/limits.hpp has their ranges.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class Limit : std::uint8_t {
  kPredictedError_urad = 0,  // an attitude with a larger expected error is doubtful
  kAttitudeJump_urad = 1,    // an attitude farther than this from the extrapolated one is doubtful
  kStepBudget_us = 2,        // a step that takes longer is an overrun
  kScrubBlocks = 3,          // model blocks checked per cycle
};
inline constexpr int kLimits = 4;

}  // namespace tumblesight::hal
