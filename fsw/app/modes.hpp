// Modes and the one table of what leads from each to which.
//
//   BOOT     init() is looking for a model
//   STANDBY  waits for commands; no attitude
//   RUN      every good frame gives an attitude
//   SAFE     a fault, or no model: no attitude; commands and telemetry go on, and the housekeeping says why
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::fsw {

enum class Mode : std::uint8_t { kBoot = 0, kStandby = 1, kRun = 2, kSafe = 3 };

enum class Cause : std::uint8_t {
  kNone = 0,
  kModelFound,
  kNoModel,
  kCommandStandby,
  kCommandRun,
  kCommandSafe,
  kFault,      // a response of the fault table
  kAssertion,  // a bug in our code
};

struct Transition {
  Mode from;
  Cause cause;
  Mode to;
};

// What is not here does not happen: a command that asks for it is refused.
inline constexpr std::array<Transition, 16> kTransitions{{
    {Mode::kBoot, Cause::kModelFound, Mode::kRun},
    {Mode::kBoot, Cause::kNoModel, Mode::kSafe},
    {Mode::kBoot, Cause::kAssertion, Mode::kSafe},
    {Mode::kStandby, Cause::kCommandStandby, Mode::kStandby},
    {Mode::kStandby, Cause::kCommandRun, Mode::kRun},
    {Mode::kStandby, Cause::kCommandSafe, Mode::kSafe},
    {Mode::kStandby, Cause::kFault, Mode::kSafe},
    {Mode::kStandby, Cause::kAssertion, Mode::kSafe},
    {Mode::kRun, Cause::kCommandStandby, Mode::kStandby},
    {Mode::kRun, Cause::kCommandRun, Mode::kRun},
    {Mode::kRun, Cause::kCommandSafe, Mode::kSafe},
    {Mode::kRun, Cause::kFault, Mode::kSafe},
    {Mode::kRun, Cause::kAssertion, Mode::kSafe},
    {Mode::kSafe, Cause::kCommandStandby, Mode::kStandby},
    {Mode::kSafe, Cause::kCommandSafe, Mode::kSafe},
    {Mode::kSafe, Cause::kAssertion, Mode::kSafe},
}};

// False, and `to` untouched: the table has no such transition.
constexpr bool next_mode(Mode from, Cause cause, Mode& to) {
  for (const Transition& transition : kTransitions) {
    if (transition.from == from && transition.cause == cause) {
      to = transition.to;
      return true;
    }
  }
  return false;
}

}  // namespace tumblesight::fsw
