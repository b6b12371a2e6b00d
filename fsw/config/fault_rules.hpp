// The fault table: how long each fault must persist, and the response to it.
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

struct FaultRule {
  Fault fault;
  std::uint16_t persistence_cycles;  // consecutive cycles with the fault before the response
  Response response;
  bool can_be_disabled;  // by DISABLE_RESPONSE; false where no attitude can be trusted with the fault
};

inline constexpr std::array<FaultRule, kFaults> kFaultRules{{
    {Fault::kStateLost, 1, Response::kResetSequence, false},
    {Fault::kModelCorrupted, 1, Response::kSwitchBank, false},
    {Fault::kAttitudeUnsound, 1, Response::kResetSequence, true},
    {Fault::kErrorLarge, 10, Response::kFlag, true},
    {Fault::kAttitudeJump, 3, Response::kResetSequence, true},
    {Fault::kOutage, 4, Response::kFlag, true},
    {Fault::kDeadline, 3, Response::kFlag, true},
    {Fault::kSlip, 3, Response::kFlag, true},
    {Fault::kFrameFrozen, 3, Response::kFlag, true},
}};

}  // namespace config
}  // namespace tumblesight::fsw
