// The fault table: when a fault persists, when it is over, and the response to it.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/fault.hpp"

namespace tumblesight::fsw {

using hal::Fault;
using hal::kFaults;
using hal::Response;

// Whether the fault depends on the speed of the machine and not on the inputs.
constexpr bool is_of_timing(Fault fault) {
  return fault == Fault::kDeadline || fault == Fault::kSlip;
}

namespace config {

// Most cycles that a rule can look back.
inline constexpr int kMaxFaultWindow_cycles = 32;

// A fault persists when it was present in `cycles` of the last `window_cycles` cycles. It is over after
// `good_cycles` consecutive cycles without it.
struct FaultRule {
  Fault fault;
  std::uint8_t cycles;
  std::uint8_t window_cycles;
  std::uint8_t good_cycles;
  Response response;
  bool can_be_disabled;  // by DISABLE_RESPONSE; false where no attitude can be trusted with the fault
};

inline constexpr std::array<FaultRule, kFaults> kFaultRules{{
    {Fault::kStateLost, 1, 1, 1, Response::kResetSequence, false},
    {Fault::kModelCorrupted, 1, 1, 1, Response::kSwitchBank, false},
    {Fault::kAttitudeUnsound, 1, 1, 1, Response::kResetSequence, true},
    {Fault::kErrorLarge, 10, 20, 10, Response::kFlag, true},
    {Fault::kAttitudeJump, 3, 6, 3, Response::kResetSequence, true},
    {Fault::kOutage, 4, 8, 4, Response::kFlag, true},
    {Fault::kDeadline, 3, 8, 3, Response::kFlag, true},
    {Fault::kSlip, 3, 8, 3, Response::kFlag, true},
    {Fault::kFrameFrozen, 3, 8, 3, Response::kFlag, true},
    {Fault::kTrackRestarts, 3, 16, 16, Response::kFlag, true},
}};

}  // namespace config
}  // namespace tumblesight::fsw
