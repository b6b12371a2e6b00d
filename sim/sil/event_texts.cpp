#include "sim/sil/event_texts.hpp"

namespace tumblesight::sim {

std::string text_of(hal::EventId id) {
  // Without a default, so that the compiler finds an event that lacks its text.
  switch (id) {
    case hal::EventId::kModelActivated:
      return "model activated";
    case hal::EventId::kModelRefused:
      return "model image refused";
    case hal::EventId::kUploadFailed:
      return "model image not written";
    case hal::EventId::kCommandAccepted:
      return "telecommand accepted";
    case hal::EventId::kCycleTimeNotAdvancing:
      return "cycle time does not advance";
    case hal::EventId::kCycleSlipped:
      return "cycle missed";
    case hal::EventId::kDeadlineOverrun:
      return "deadline overrun";
    case hal::EventId::kTimingFaultPersists:
      return "timing fault persists";
    case hal::EventId::kTimingFaultOver:
      return "timing fault over";
    case hal::EventId::kTimingEventsSuppressed:
      return "timing events suppressed";
    case hal::EventId::kFrameMissing:
      return "no frame";
    case hal::EventId::kFrameDuplicate:
      return "frame with a number already used";
    case hal::EventId::kFrameExposureBackwards:
      return "frame exposed before the last one";
    case hal::EventId::kFrameStale:
      return "frame too old";
    case hal::EventId::kFrameFromFuture:
      return "frame from the future";
    case hal::EventId::kFrameBad:
      return "frame with bad content";
    case hal::EventId::kFrameWrongSize:
      return "frame of a wrong size";
    case hal::EventId::kSequenceSkipped:
      return "frame numbers skipped";
    case hal::EventId::kFrameTooSoon:
      return "frame too soon after the last one";
    case hal::EventId::kFrameRepeated:
      return "frame repeated, the sensor is frozen";
    case hal::EventId::kEstimatorResetByGap:
      return "new sequence after a gap";
    case hal::EventId::kEstimatorResetByFault:
      return "new sequence after a fault";
    case hal::EventId::kAttitudeDoubtful:
      return "attitude doubtful";
    case hal::EventId::kFrameWithoutChaser:
      return "frame without the attitude of the chaser";
    case hal::EventId::kPoseVerified:
      return "pose verified";
    case hal::EventId::kPoseDoubtful:
      return "pose doubtful";
    case hal::EventId::kAssertion:
      return "assertion failed, the mode is SAFE";
    case hal::EventId::kFaultPersists:
      return "fault persists";
    case hal::EventId::kFaultOver:
      return "fault over";
    case hal::EventId::kSafeEntered:
      return "the mode became SAFE";
    case hal::EventId::kCommandForged:
      return "telecommand with a wrong signature";
    case hal::EventId::kCommandReplayed:
      return "telecommand repeated";
    case hal::EventId::kCommandMalformed:
      return "telecommand malformed";
    case hal::EventId::kCommandWrongLength:
      return "telecommand of a wrong length";
    case hal::EventId::kCommandWrongChecksum:
      return "telecommand with a wrong checksum";
    case hal::EventId::kCommandUnknown:
      return "telecommand unknown";
    case hal::EventId::kCommandWrongMode:
      return "telecommand not possible in this mode";
    case hal::EventId::kCommandWrongArgument:
      return "telecommand with a wrong argument";
    case hal::EventId::kCommandNoModel:
      return "telecommand without a model to act on";
    case hal::EventId::kCommandBusy:
      return "telecommand while another one is carried out";
    case hal::EventId::kMemoryCorrected:
      return "memory errors corrected";
    case hal::EventId::kStateRestored:
      return "state of the estimator restored";
    case hal::EventId::kConstantsReloaded:
      return "copy of the model data reloaded";
    case hal::EventId::kModelRepaired:
      return "model image repaired";
    case hal::EventId::kModelBlockLost:
      return "block of the model image lost";
    case hal::EventId::kModelTableRebuilt:
      return "checksums of the model image rebuilt";
    case hal::EventId::kBankSwitched:
      return "changed to the other model bank";
    case hal::EventId::kFallbackLost:
      return "image of the other model bank lost";
    case hal::EventId::kStateResumed:
      return "state of before the reset resumed";
    case hal::EventId::kStoredStateLost:
      return "stored state lost, the mode is SAFE";
    case hal::EventId::kStateNotStored:
      return "state not stored";
    case hal::EventId::kStoredCopyUnusable:
      return "a copy of the stored state is unusable";
    case hal::EventId::kStoreGivenUp:
      return "store given up";
    case hal::EventId::kStoreUsable:
      return "store usable again";
    case hal::EventId::kChangeNotStored:
      return "a change was not stored";
    case hal::EventId::kEventsSuppressed:
      return "events suppressed";
    case hal::EventId::kCommandOutOfWindow:
      return "telecommand with a counter too far ahead";
    case hal::EventId::kCommandOtherKey:
      return "telecommand for another key";
    case hal::EventId::kCommandOtherSpacecraft:
      return "telecommand for another spacecraft";
    case hal::EventId::kCommandNotStored:
      return "telecommand refused, its counter could not be stored";
    case hal::EventId::kCommandStoreFailed:
      return "telecommand failed, the store cannot be written";
    case hal::EventId::kCommandNoRoom:
      return "telecommand without room for it";
    case hal::EventId::kCommandIncomplete:
      return "telecommand for an image that lacks segments";
    case hal::EventId::kKeyActivated:
      return "another command key activated";
  }
  return "unknown";
}

}  // namespace tumblesight::sim
