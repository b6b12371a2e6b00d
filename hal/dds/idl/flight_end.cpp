#include "hal/dds/idl/flight_end.hpp"

namespace tumblesight::hal::dds {

const char* to_string(FlightEnd end) {
  switch (end) {
    case FlightEnd::kComplete:
      return "complete";
    case FlightEnd::kBadArguments:
      return "bad arguments";
    case FlightEnd::kIcdUnequal:
      return "the simulator was built from another interface definition";
    case FlightEnd::kSimulatorGone:
      return "the simulator is gone";
    case FlightEnd::kSilence:
      return "no message from a simulator within the timeout";
    case FlightEnd::kTransport:
      return "DDS failed";
    case FlightEnd::kStepOutOfOrder:
      return "a step is out of order, or its samples are not those that it announces";
    case FlightEnd::kHeapUsed:
      return "the flight task used the heap";
    case FlightEnd::kNoThread:
      return "the system provided no thread for the flight task";
    case FlightEnd::kNoFloat32Program:
      return "flight_float32 cannot be started";
    case FlightEnd::kForeign:
      return "a program other than the simulator writes to the topics of this run";
    case FlightEnd::kPacketsLost:
      return "not all telemetry packets could be written";
    case FlightEnd::kOtherSubject:
      return "the simulator expects another target or model image";
    case FlightEnd::kSecondFlight:
      return "another flight program is on the DDS domain";
    case FlightEnd::kInterrupted:
      return "interrupted";
    case FlightEnd::kTerminated:
      return "asked to stop";
  }
  return "a status that Tumblesight's flight program does not have";
}

}  // namespace tumblesight::hal::dds
