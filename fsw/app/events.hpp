// The events of the flight application. Numbers are part of the interface (docs/icd.md): never reused, never
// changed.
#pragma once

#include <cstdint>

namespace tumblesight::fsw {

enum class Severity : std::uint8_t { kInformation = 0, kWarning = 1, kError = 2 };

// Arguments in brackets. Sequence numbers are given as the bits of the unsigned number; times in
// milliseconds, clamped to 32 bits.
enum class EventId : std::uint16_t {
  kModelActivated = 1,  // information [image size in bytes, fsw::Mode after, -]; the estimator starts anew
  kModelRefused = 2,    // error [gnc::ModelStatus, image size in bytes, -]

  kCommandAccepted = 10,  // information [opcode, fsw::Mode before, fsw::Mode after]
  kCommandRefused = 11,   // warning [opcode, payload size, fsw::CommandRefusal]

  kCycleTimeNotAdvancing = 20,  // error [this cycle minus the previous one, frames refused with it, -]

  kFrameMissing = 30,            // warning, first cycle of an outage only [last accepted number, -, -]
  kFrameDuplicate = 31,          // warning [sequence number, -, -]
  kFrameExposureBackwards = 32,  // warning [sequence number, exposure minus last accepted exposure, -]
  kFrameStale = 33,              // warning [sequence number, age, -]
  kFrameFromFuture = 34,         // warning [sequence number, exposure minus cycle time, -]
  kFrameBad = 35,                // warning [sequence number, gnc::FrameStatus, rays to a side]
  kFrameWrongSize = 36,          // warning [-, -, -]; the sensor interface dropped what was no frame
  kSequenceSkipped = 37,  // warning [number expected, number received, numbers skipped; -1: it went back]

  kEstimatorResetByGap = 40,  // warning [exposure gap, frames since the last reset, -]

  kAssertion =
      50,  // error [fsw::file_id of the source file, line, assertions since start]; the mode is SAFE now
};

enum class CommandRefusal : std::uint8_t {
  kUnknownOpcode = 1,
  kWrongLength = 2,
  kNoModel = 3,  // ESTIMATE without a model
  kSafe = 4,     // ESTIMATE in SAFE: STANDBY first
};

}  // namespace tumblesight::fsw
