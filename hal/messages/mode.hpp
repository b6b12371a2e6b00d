// Modes of the flight application and the causes of mode changes. The numbers are part of the interface
// (docs/icd.md); fsw/app/modes.hpp has the transition table.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class Mode : std::uint8_t {
  kBoot = 0,     // init() looks for a model
  kStandby = 1,  // waits for commands; no attitude
  kRun = 2,      // every good frame gives an attitude
  kSafe = 3,     // after a fault or without a model: no attitude; commands and telemetry continue
};

enum class Cause : std::uint8_t {
  kNone = 0,
  kModelFound = 1,
  kNoModel = 2,
  kCommandStandby = 3,
  kCommandRun = 4,
  kCommandSafe = 5,
  kFault = 6,             // a response from the fault table
  kAssertion = 7,         // a bug in the flight software
  kResumedStandby = 8,    // STANDBY before the reset, or an abnormal reset
  kResumedSafe = 9,       // SAFE before the reset
  kStoredStateLost = 10,  // a reset, and the stored state is lost, at least in part
};
inline constexpr Cause kLastCause = Cause::kStoredStateLost;

}  // namespace tumblesight::hal
