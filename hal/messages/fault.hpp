// Faults that the application supervises, and the responses to them. The numbers are part of the interface
// (docs/icd.md); fsw/config/fault_rules.hpp says which fault gets which response.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class Fault : std::uint8_t {
  kStateLost = 0,        // the estimator's state and its copy, or two copies of the application's state, are
                         // corrupted
  kModelCorrupted = 1,   // the model in use is corrupted and cannot be repaired
  kAttitudeUnsound = 2,  // not a unit quaternion, or an expected error above pi
  kErrorLarge = 3,       // expected error above its limit
  kAttitudeJump = 4,     // too far from the attitude that the track predicted
  kOutage = 5,           // no usable frame in RUN
  kDeadline = 6,         // the previous cycle took longer than its budget
  kSlip = 7,             // the task missed one or more releases
  kFrameFrozen = 8,      // ranges like those of one of the last eight used frames, with a new sequence number
  kTrackRestarts = 9,    // the estimator was reset in this cycle, and not by command
};
inline constexpr int kFaults = 10;

enum class Response : std::uint8_t {
  kIgnore = 0,         // none; the fault is only shown in the telemetry
  kFlag = 1,           // an event
  kResetSequence = 2,  // an event, and the estimator is reset
  kSwitchBank = 3,     // an event, and the other bank's model is activated; without a good one there: SAFE
  kSafe = 4,           // an event, and the mode becomes SAFE
};

}  // namespace tumblesight::hal
