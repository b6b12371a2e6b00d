// Why the processor was started. The numbers are part of the interface (docs/icd.md).
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class ResetCause : std::uint8_t {
  kPowerOn = 0,
  kCommanded = 1,  // by the ground or the executive
  kWatchdog = 2,
  kOther = 3,  // an exception, an upset, or unknown
};

// Whether something went wrong before the reset.
constexpr bool is_abnormal(ResetCause cause) {
  return cause != ResetCause::kPowerOn && cause != ResetCause::kCommanded;
}

}  // namespace tumblesight::hal
