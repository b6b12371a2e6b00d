// What the events of the flight application mean, for logs and reports.
#pragma once

#include "hal/messages/event_id.hpp"

namespace tumblesight::hal {

// "no frame". "unknown" for a number that is not of an event.
constexpr const char* text_of(EventId id) {
  // Without a default, so that the compiler finds an event that lacks its text.
  switch (id) {
    case EventId::kModelActivated:
      return "model activated";
    case EventId::kModelRefused:
      return "model image refused";
    case EventId::kUploadFailed:
      return "model image not written";
    case EventId::kCommandAccepted:
      return "telecommand accepted";
    case EventId::kCycleTimeNotAdvancing:
      return "cycle time does not advance";
    case EventId::kCycleSlipped:
      return "cycle missed";
    case EventId::kDeadlineOverrun:
      return "deadline overrun";
    case EventId::kTimingFaultPersists:
      return "timing fault persists";
    case EventId::kTimingFaultOver:
      return "timing fault over";
    case EventId::kTimingEventsSuppressed:
      return "timing events suppressed";
    case EventId::kFrameMissing:
      return "no frame";
    case EventId::kFrameDuplicate:
      return "frame with a number already used";
    case EventId::kFrameExposureBackwards:
      return "frame exposed before the last one";
    case EventId::kFrameStale:
      return "frame too old";
    case EventId::kFrameFromFuture:
      return "frame from the future";
    case EventId::kFrameBad:
      return "frame with bad content";
    case EventId::kFrameWrongSize:
      return "frame of a wrong size";
    case EventId::kSequenceSkipped:
      return "frame numbers skipped";
    case EventId::kFrameTooSoon:
      return "frame too soon after the last one";
    case EventId::kFrameRepeated:
      return "frame repeated, the sensor is frozen";
    case EventId::kEstimatorResetByGap:
      return "new sequence after a gap";
    case EventId::kEstimatorResetByFault:
      return "new sequence after a fault";
    case EventId::kAttitudeDoubtful:
      return "attitude doubtful";
    case EventId::kFrameWithoutChaser:
      return "frame without the attitude of the chaser";
    case EventId::kPoseVerified:
      return "pose verified";
    case EventId::kPoseDoubtful:
      return "pose doubtful";
    case EventId::kAssertion:
      return "assertion failed, the mode is SAFE";
    case EventId::kFaultPersists:
      return "fault persists";
    case EventId::kFaultOver:
      return "fault over";
    case EventId::kSafeEntered:
      return "the mode became SAFE";
    case EventId::kCommandForged:
      return "telecommand with a wrong signature";
    case EventId::kCommandReplayed:
      return "telecommand repeated";
    case EventId::kCommandMalformed:
      return "telecommand malformed";
    case EventId::kCommandWrongLength:
      return "telecommand of a wrong length";
    case EventId::kCommandWrongChecksum:
      return "telecommand with a wrong checksum";
    case EventId::kCommandUnknown:
      return "telecommand unknown";
    case EventId::kCommandWrongMode:
      return "telecommand not possible in this mode";
    case EventId::kCommandWrongArgument:
      return "telecommand with a wrong argument";
    case EventId::kCommandNoModel:
      return "telecommand without a model to act on";
    case EventId::kCommandBusy:
      return "telecommand while another one is carried out";
    case EventId::kMemoryCorrected:
      return "memory errors corrected";
    case EventId::kStateRestored:
      return "state of the estimator restored";
    case EventId::kConstantsReloaded:
      return "copy of the model data reloaded";
    case EventId::kModelRepaired:
      return "model image repaired";
    case EventId::kModelBlockLost:
      return "block of the model image lost";
    case EventId::kModelTableRebuilt:
      return "checksums of the model image rebuilt";
    case EventId::kBankSwitched:
      return "changed to the other model bank";
    case EventId::kFallbackLost:
      return "image of the other model bank lost";
    case EventId::kStateResumed:
      return "state of before the reset resumed";
    case EventId::kStoredStateLost:
      return "stored state lost, the mode is SAFE";
    case EventId::kStateNotStored:
      return "state not stored";
    case EventId::kStoredCopyUnusable:
      return "a copy of the stored state is unusable";
    case EventId::kStoreGivenUp:
      return "store given up";
    case EventId::kStoreUsable:
      return "store usable again";
    case EventId::kChangeNotStored:
      return "a change was not stored";
    case EventId::kEventsSuppressed:
      return "events suppressed";
    case EventId::kCommandOutOfWindow:
      return "telecommand with a counter too far ahead";
    case EventId::kCommandOtherKey:
      return "telecommand for another key";
    case EventId::kCommandOtherSpacecraft:
      return "telecommand for another spacecraft";
    case EventId::kCommandNotStored:
      return "telecommand refused, its counter could not be stored";
    case EventId::kCommandStoreFailed:
      return "telecommand failed, the store cannot be written";
    case EventId::kCommandNoRoom:
      return "telecommand without room for it";
    case EventId::kCommandIncomplete:
      return "telecommand for an image that lacks segments";
    case EventId::kKeyActivated:
      return "another command key activated";
  }
  return "unknown";
}

}  // namespace tumblesight::hal
