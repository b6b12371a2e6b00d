// The events of the flight application. Numbers are part of the interface (docs/icd.md): never reused, never
// changed. Retired: 11.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/telecommand.hpp"

namespace tumblesight::fsw {

enum class Severity : std::uint8_t { kInformation = 0, kWarning = 1, kError = 2 };

// Arguments in brackets. Sequence numbers are given as the bits of the unsigned number; times in
// milliseconds, clamped to 32 bits.
enum class EventId : std::uint16_t {
  kModelActivated = 1,  // [image size in bytes, bank, -]; the estimator starts anew
  kModelRefused = 2,    // [gnc::ModelStatus, image size in bytes, bank]

  kCommandAccepted = 10,  // [function code, Mode before, Mode after]

  kCycleTimeNotAdvancing = 20,  // [this cycle minus the previous one, frames refused with it, -]
  // 21 to 29 tell of the wall clock, so that no digest of a deterministic run may cover them.
  kCycleSlipped = 21,            // [releases missed, -, -]
  kDeadlineOverrun = 22,         // [time of this step, -, -]
  kTimingFaultPersists = 23,     // [Fault, Response taken, cycles of its rule]
  kTimingFaultOver = 24,         // [Fault, -, -]
  kTimingEventsSuppressed = 25,  // [EventId of these, how many, -]

  kFrameMissing = 30,            // first cycle of an outage only [last accepted number, -, -]
  kFrameDuplicate = 31,          // [sequence number, -, -]
  kFrameExposureBackwards = 32,  // [sequence number, exposure minus last accepted exposure, -]
  kFrameStale = 33,              // [sequence number, age, -]
  kFrameFromFuture = 34,         // [sequence number, exposure minus cycle time, -]
  kFrameBad = 35,                // [sequence number, gnc::FrameStatus, rays to a side]
  kFrameWrongSize = 36,          // [-, -, -]; the sensor interface dropped what was no frame
  kSequenceSkipped = 37,         // [number expected, number received, numbers skipped; -1: it went back]

  kEstimatorResetByGap = 40,    // [exposure gap, frames since the last reset, -]
  kEstimatorResetByFault = 41,  // [Fault, -, -]
  kAttitudeDoubtful = 42,       // [sequence number, expected error in mrad, 1: it jumped + 2: a frozen frame]

  kAssertion = 50,      // [file_id of the source file, line, assertions since start]; the mode is SAFE now
  kFaultPersists = 51,  // [Fault, Response taken, cycles of its rule]
  kFaultOver = 52,      // [Fault, -, -]
  kSafeEntered = 53,    // [Cause, Fault or -1, -]

  kCommandForged = 60,  // 60 + CommandRefusal: [function code or 0, bytes, detail]
  kCommandReplayed = 61,
  kCommandMalformed = 62,
  kCommandWrongLength = 63,
  kCommandWrongChecksum = 64,
  kCommandUnknown = 65,
  kCommandWrongMode = 66,
  kCommandWrongArgument = 67,
  kCommandNoModel = 68,
  kCommandBusy = 69,

  kMemoryCorrected = 70,    // [words that the vote corrected, -, -]
  kStateRestored = 71,      // [-, -, -]; the estimator's state, from its copy
  kConstantsReloaded = 72,  // [bank, -, -]; what the application keeps of the model, from the bank
  kModelRepaired = 73,      // [bank, block, -]; from the other bank
  kModelBlockLost = 74,     // [bank, block, -]; no bank has it
  kModelTableRebuilt = 75,  // [bank, -, -]; the blocks' checksums
  kBankSwitched = 76,       // [bank before, bank after, -]

  kEventsSuppressed = 90,  // [EventId of the others, how many, -]
};

struct EventRule {
  EventId id;
  Severity severity;
};
inline constexpr std::array<EventRule, 42> kEventRules{{
    {EventId::kModelActivated, Severity::kInformation},
    {EventId::kModelRefused, Severity::kError},
    {EventId::kCommandAccepted, Severity::kInformation},
    {EventId::kCycleTimeNotAdvancing, Severity::kError},
    {EventId::kCycleSlipped, Severity::kWarning},
    {EventId::kDeadlineOverrun, Severity::kWarning},
    {EventId::kTimingFaultPersists, Severity::kWarning},
    {EventId::kTimingFaultOver, Severity::kInformation},
    {EventId::kTimingEventsSuppressed, Severity::kInformation},
    {EventId::kFrameMissing, Severity::kWarning},
    {EventId::kFrameDuplicate, Severity::kWarning},
    {EventId::kFrameExposureBackwards, Severity::kWarning},
    {EventId::kFrameStale, Severity::kWarning},
    {EventId::kFrameFromFuture, Severity::kWarning},
    {EventId::kFrameBad, Severity::kWarning},
    {EventId::kFrameWrongSize, Severity::kWarning},
    {EventId::kSequenceSkipped, Severity::kWarning},
    {EventId::kEstimatorResetByGap, Severity::kWarning},
    {EventId::kEstimatorResetByFault, Severity::kWarning},
    {EventId::kAttitudeDoubtful, Severity::kInformation},
    {EventId::kAssertion, Severity::kError},
    {EventId::kFaultPersists, Severity::kWarning},
    {EventId::kFaultOver, Severity::kInformation},
    {EventId::kSafeEntered, Severity::kError},
    {EventId::kCommandForged, Severity::kWarning},
    {EventId::kCommandReplayed, Severity::kWarning},
    {EventId::kCommandMalformed, Severity::kWarning},
    {EventId::kCommandWrongLength, Severity::kWarning},
    {EventId::kCommandWrongChecksum, Severity::kWarning},
    {EventId::kCommandUnknown, Severity::kWarning},
    {EventId::kCommandWrongMode, Severity::kWarning},
    {EventId::kCommandWrongArgument, Severity::kWarning},
    {EventId::kCommandNoModel, Severity::kWarning},
    {EventId::kCommandBusy, Severity::kWarning},
    {EventId::kMemoryCorrected, Severity::kWarning},
    {EventId::kStateRestored, Severity::kWarning},
    {EventId::kConstantsReloaded, Severity::kWarning},
    {EventId::kModelRepaired, Severity::kWarning},
    {EventId::kModelBlockLost, Severity::kError},
    {EventId::kModelTableRebuilt, Severity::kWarning},
    {EventId::kBankSwitched, Severity::kWarning},
    {EventId::kEventsSuppressed, Severity::kInformation},
}};

constexpr EventId event_of(CommandRefusal why) {
  return static_cast<EventId>(static_cast<int>(EventId::kCommandForged) + static_cast<int>(why));
}

}  // namespace tumblesight::fsw
