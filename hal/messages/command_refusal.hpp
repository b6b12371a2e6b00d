// Why a telecommand was refused. The numbers are part of the interface (docs/icd.md): never changed, never
// reused. The first check that fails gives the reason; docs/icd.md has the order of the checks.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class CommandRefusal : std::uint8_t {
  kForged = 0,         // too short for a trailer, or the authentication code is wrong
  kReplayed = 1,       // counter not higher than in the last authentic command
  kMalformed = 2,      // version, type, secondary header flag, sequence flags, APID, or a reserved field
  kWrongLength = 3,    // the length field does not match the packet, or the arguments the function
  kWrongChecksum = 4,  // checksum of the secondary header
  kUnknownFunction = 5,
  kWrongMode = 6,      // the function is not allowed in this mode
  kWrongArgument = 7,  // an argument is out of range
  kNoModel = 8,  // no model to run, copy, load, validate or activate; the event gives the gnc::ModelStatus
  kBusy = 9,     // this cycle already has a dump, or a long task; or the bank is still being written
  kOutOfWindow = 10,      // counter more than 65,536 ahead of the last authentic command
  kOtherKey = 11,         // signed by a key slot that is not in use
  kOtherSpacecraft = 12,  // authentic, but for another spacecraft
  kNotStored = 13,        // counter or key slot could not be stored, so a reset would make a replay possible
  kStoreFailed = 14,      // the model store could not erase or write the bank
  kNoRoom = 15,           // the link's queue was full
  kIncomplete = 16,       // segments of the image are missing; the event gives their number
};
inline constexpr int kCommandRefusals = 17;

}  // namespace tumblesight::hal
