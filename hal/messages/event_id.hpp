// The events of the flight application and their severity. The numbers are part of the interface
// (docs/icd.md): never changed, never reused. Retired: 11.
#pragma once

#include <array>
#include <cstdint>

#include "hal/messages/command_refusal.hpp"

namespace tumblesight::hal {

enum class Severity : std::uint8_t { kInformation = 0, kWarning = 1, kError = 2 };

// The three arguments are in brackets. A sequence number is given as the bits of the unsigned number. Times
// are in milliseconds, clamped to 32 bits.
enum class EventId : std::uint16_t {
  kModelActivated = 1,  // [image size in bytes, bank, -]; the estimator is reset
  kModelRefused = 2,    // [gnc::ModelStatus, image size in bytes, bank]
  kUploadFailed = 3,    // [bank, segments missing, -]; the store could not write the copy of the image in use

  kCommandAccepted = 10,  // [function code, Mode before, Mode after]

  kCycleTimeNotAdvancing = 20,  // [this cycle minus the previous one, frames refused with it, -]

  // Events 21 to 29 depend on the wall clock, so no digest of a deterministic run may include them.
  kCycleSlipped = 21,            // [releases missed, -, -]
  kDeadlineOverrun = 22,         // [time of this step, -, -]
  kTimingFaultPersists = 23,     // [Fault, Response taken, cycles with the fault that its rule requires]
  kTimingFaultOver = 24,         // [Fault, -, -]
  kTimingEventsSuppressed = 25,  // [EventId of the suppressed events, their number, -]

  kFrameMissing = 30,            // first cycle of an outage only [last accepted number, -, -]
  kFrameDuplicate = 31,          // [sequence number, -, -]
  kFrameExposureBackwards = 32,  // [sequence number, exposure minus last accepted exposure, -]
  kFrameStale = 33,              // [sequence number, age, -]
  kFrameFromFuture = 34,         // [sequence number, exposure minus cycle time, -]
  kFrameBad = 35,                // [sequence number, gnc::FrameStatus, rays per side]
  kFrameWrongSize = 36,          // [-, -, -]; the sensor interface dropped data that is not a frame
  kSequenceSkipped = 37,         // [number expected, number received, numbers skipped; -1: it went back]
  kFrameTooSoon = 38,            // [sequence number, exposure minus last accepted exposure, -]
  kFrameRepeated = 39,           // [sequence number, -, -]; a frozen sensor

  kEstimatorResetByGap = 40,  // [exposure gap, frames since the last reset, 1: the chaser's attitude is known
                              // from now on, or no more]
  kEstimatorResetByFault = 41,  // [Fault, -, -]
  kAttitudeDoubtful = 42,       // [sequence number, expected error in mrad, 1: jump + 2: unexplained]
  kFrameWithoutChaser = 43,     // [sequence number, exposure minus last accepted exposure, -]
  kPoseVerified = 44,           // [sequence number, frames it was fitted to, -]; after one that was not
  kPoseDoubtful = 45,           // [sequence number, AttitudeReport::pose_doubts, -]; after a verified one

  kAssertion = 50,      // [file_id of the source file, line, assertions since start]; the mode is SAFE now
  kFaultPersists = 51,  // [Fault, Response taken, cycles with the fault that its rule requires]
  kFaultOver = 52,      // [Fault, -, -]
  kSafeEntered = 53,    // [Cause, Fault or -1, -]

  // 60 + CommandRefusal; from refusal 10 on, 90 + CommandRefusal
  kCommandForged = 60,  // [function code or 0, packet size in bytes or 0, detail]
  kCommandReplayed = 61,
  kCommandMalformed = 62,
  kCommandWrongLength = 63,
  kCommandWrongChecksum = 64,
  kCommandUnknown = 65,
  kCommandWrongMode = 66,
  kCommandWrongArgument = 67,
  kCommandNoModel = 68,
  kCommandBusy = 69,

  kMemoryCorrected = 70,    // [words corrected by the vote, -, -]
  kStateRestored = 71,      // [-, -, -]; the estimator's state, from its copy
  kConstantsReloaded = 72,  // [bank, -, -]; the estimator's copy of model data, from the bank
  kModelRepaired = 73,      // [bank, block, -]; from the other bank
  kModelBlockLost = 74,     // [bank, block, -]; it cannot be repaired
  kModelTableRebuilt = 75,  // [bank, -, -]; the checksums of the blocks
  kBankSwitched = 76,       // [bank before, bank after, -]
  kFallbackLost = 77,       // [bank, -, -]; the image of the bank that is not in use is no longer good

  kStateResumed = 80,  // [ResetCause, stored Mode, stored bank]; the stored state of before the reset is used
  kStoredStateLost =
      81,                // [StoreStatus of copy 0, StoreStatus of copy 1, sum of StateLoss]; the mode is SAFE
  kStateNotStored = 82,  // [copies that hold the newest record, -, -]; when they become fewer
  kStoredCopyUnusable =
      83,  // [StoreStatus of copy 0, StoreStatus of copy 1, -]; at boot; the state is that of the other copy
  kStoreGivenUp = 84,     // [cycles without a copy, -, -]; commands are carried out as without a store
  kStoreUsable = 85,      // [copies that hold the newest record, -, -]; after the store was given up
  kChangeNotStored = 86,  // [key slot, Mode, bank in use]; one of these, the table or the disabled responses
                          // changed while the store was given up: a reset brings the old ones back

  kEventsSuppressed = 90,  // [EventId of the suppressed events, their number, -]

  kCommandOutOfWindow = 100,
  kCommandOtherKey = 101,
  kCommandOtherSpacecraft = 102,
  kCommandNotStored = 103,
  kCommandStoreFailed = 104,
  kCommandNoRoom = 105,
  kCommandIncomplete = 106,
  kKeyActivated = 110,  // [key slot before, key slot after, -]
};

struct EventRule {
  EventId id;
  Severity severity;
};
inline constexpr std::array<EventRule, 64> kEventRules{{
    {EventId::kModelActivated, Severity::kInformation},
    {EventId::kModelRefused, Severity::kError},
    {EventId::kUploadFailed, Severity::kError},
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
    {EventId::kFrameTooSoon, Severity::kWarning},
    {EventId::kFrameRepeated, Severity::kWarning},
    {EventId::kEstimatorResetByGap, Severity::kWarning},
    {EventId::kEstimatorResetByFault, Severity::kWarning},
    {EventId::kAttitudeDoubtful, Severity::kInformation},
    {EventId::kFrameWithoutChaser, Severity::kWarning},
    {EventId::kPoseVerified, Severity::kInformation},
    {EventId::kPoseDoubtful, Severity::kInformation},
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
    {EventId::kFallbackLost, Severity::kError},
    {EventId::kStateResumed, Severity::kWarning},
    {EventId::kStoredStateLost, Severity::kError},
    {EventId::kStateNotStored, Severity::kError},
    {EventId::kStoredCopyUnusable, Severity::kWarning},
    {EventId::kStoreGivenUp, Severity::kError},
    {EventId::kStoreUsable, Severity::kInformation},
    {EventId::kChangeNotStored, Severity::kError},
    {EventId::kEventsSuppressed, Severity::kInformation},
    {EventId::kCommandOutOfWindow, Severity::kWarning},
    {EventId::kCommandOtherKey, Severity::kWarning},
    {EventId::kCommandOtherSpacecraft, Severity::kWarning},
    {EventId::kCommandNotStored, Severity::kError},
    {EventId::kCommandStoreFailed, Severity::kError},
    {EventId::kCommandNoRoom, Severity::kWarning},
    {EventId::kCommandIncomplete, Severity::kWarning},
    {EventId::kKeyActivated, Severity::kWarning},
}};

// The event that reports a refusal.
constexpr EventId event_of(CommandRefusal why) {
  const int first = static_cast<int>(why) < 10 ? 60 : 90;
  return static_cast<EventId>(first + static_cast<int>(why));
}

// Whether the event differs between two runs with the same inputs.
constexpr bool depends_on_wall_clock(EventId id) {
  return static_cast<int>(id) > 20 && static_cast<int>(id) < 30;
}

}  // namespace tumblesight::hal
