// Why the flight program ended. The numbers are its exit statuses.
#pragma once

namespace tumblesight::hal::dds {

enum class FlightEnd : int {
  kComplete = 0,  // the last step is done
  kBadArguments = 2,
  kIcdUnequal = 3,         // simulator and flight were built from different interface definitions
  kSimulatorGone = 4,      // killed, or the connection was lost
  kSilence = 5,            // no simulator, or no step from it, within the timeout
  kTransport = 6,          // DDS could not be set up or refused a sample
  kStepOutOfOrder = 7,     // or its samples are not those that it announces
  kHeapUsed = 8,           // the run is complete, but the flight task used the heap
  kNoThread = 9,           // the flight task's thread could not be created
  kNoFloat32Program = 10,  // flight_float32 is missing or cannot be executed
  kForeign = 11,           // a program other than the simulator writes to the topics of the run
  kPacketsLost = 12,       // the run is complete, but not all telemetry packets could be written
  kOtherSubject = 13,      // the simulator expects another target or model image
  kSecondFlight = 14,      // another flight program is on the DDS domain
  kInterrupted = 130,      // by SIGINT; as a shell reports a program that a signal ends
  kTerminated = 143,       // by SIGTERM; same
};

const char* to_string(FlightEnd end);

}  // namespace tumblesight::hal::dds
