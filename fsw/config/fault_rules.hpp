// Faults of the world and of memory, and what is done about them: one table.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::fsw {

// Numbers are part of the interface (docs/icd.md).
enum class Fault : std::uint8_t {
  kStateLost = 0,        // the estimator's state was hit, and so was its copy
  kModelCorrupted = 1,   // the model in use was hit, and no good copy of the place is left
  kAttitudeUnsound = 2,  // not a unit quaternion, or an error beyond pi
  kErrorLarge = 3,       // expected error beyond its limit
  kAttitudeJump = 4,     // not where the last two attitudes lead to
  kOutage = 5,           // no usable frame, in RUN
  kDeadline = 6,         // a step beyond its budget
  kSlip = 7,             // releases of the task that had passed before it was ready
  kFrameFrozen = 8,      // the ranges of the frame before, under a new number
};
inline constexpr int kFaults = 9;

// Faults that depend on how fast the machine is, not on what came in.
constexpr bool is_of_timing(Fault fault) {
  return fault == Fault::kDeadline || fault == Fault::kSlip;
}

enum class Response : std::uint8_t {
  kIgnore = 0,         // counted
  kFlag = 1,           // and told
  kResetSequence = 2,  // and the estimator starts anew
  kSwitchBank = 3,     // and the model of the other bank is activated; if that is none: SAFE
  kSafe = 4,           // and the mode becomes SAFE
};

namespace config {

struct FaultRule {
  Fault fault;
  std::uint16_t persistence_cycles;  // so many cycles on end before it is responded to
  Response response;
  bool can_be_disabled;  // DISABLE_RESPONSE; a fault with which no attitude is worth anything cannot
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
