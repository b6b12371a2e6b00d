// Why a telecommand was refused. The numbers are part of the interface (docs/icd.md) and follow the order of
// the checks: the first check that fails gives the reason.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class CommandRefusal : std::uint8_t {
  kForged = 0,         // too short for a trailer, or the authentication code is wrong
  kReplayed = 1,       // counter not higher than in the last authentic command
  kMalformed = 2,      // version, type, secondary header flag, sequence flags, APID, or reserved field
  kWrongLength = 3,    // the length field does not match the packet, or the arguments the function
  kWrongChecksum = 4,  // CRC-16 of the packet
  kUnknownFunction = 5,
  kWrongMode = 6,      // the function is not allowed in this mode
  kWrongArgument = 7,  // an argument is out of range
  kNoModel = 8,        // no model to run, validate or activate; the event gives the gnc::ModelStatus
  kBusy = 9,           // this cycle already has a dump
};
inline constexpr int kCommandRefusals = 10;

}  // namespace tumblesight::hal
