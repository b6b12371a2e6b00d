// The table of mode transitions. A transition that is not in the table does not happen, and a command that
// asks for it is refused.
#pragma once

#include <array>

#include "hal/messages/mode.hpp"

namespace tumblesight::fsw {

using hal::Cause;
using hal::Mode;

// Whether `mode` is one of the enumerators. A flip of the same bit in two copies can make it another number.
constexpr bool is_mode(Mode mode) {
  return static_cast<std::uint8_t>(mode) <= static_cast<std::uint8_t>(Mode::kSafe);
}

struct Transition {
  Mode from;
  Cause cause;
  Mode to;
};

inline constexpr std::array<Transition, 19> kTransitions{{
    {Mode::kBoot, Cause::kModelFound, Mode::kRun},
    {Mode::kBoot, Cause::kNoModel, Mode::kSafe},
    {Mode::kBoot, Cause::kAssertion, Mode::kSafe},
    {Mode::kBoot, Cause::kResumedStandby, Mode::kStandby},
    {Mode::kBoot, Cause::kResumedSafe, Mode::kSafe},
    {Mode::kBoot, Cause::kStoredStateLost, Mode::kSafe},
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

// Writes the next mode to `to`. False: the table has no such transition and `to` is unchanged.
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
