// Telecommands: CCSDS space packets (CCSDS 133.0-B) with a secondary header, and behind them the security
// trailer. Every number is big-endian. Bit by bit: docs/icd.md.
//
//   offset  bytes  field
//        0      2  packet version 0 (3 bits), type 1 (1), secondary header 1 (1), APID 0x1F0 (11)
//        2      2  sequence flags 3 (2 bits), sequence count (14)
//        4      2  data length: bytes from offset 6 to the end of the packet, less one
//        6      1  function code
//        7      1  reserved, 0
//        8      2  checksum: CRC-16/CCITT (0x1021, from 0xFFFF) over the packet with 0 in this field
//       10      n  arguments
//   10 + n      4  trailer: counter, higher than that of every command accepted before
//   14 + n     16  trailer: first 16 bytes of HMAC-SHA-256 over all that stands before
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/link.hpp"

namespace tumblesight::fsw {

inline constexpr std::uint16_t kCommandApid = 0x1F0;
inline constexpr int kCommandHeaderBytes = 10;
inline constexpr int kCommandTrailerBytes = 20;
inline constexpr int kCommandMacBytes = 16;
inline constexpr int kMaxModelSegmentBytes = 1024;
inline constexpr int kMaxCommandArgumentBytes = 4 + kMaxModelSegmentBytes;
static_assert(kCommandHeaderBytes + kMaxCommandArgumentBytes + kCommandTrailerBytes <=
              hal::CommandPacket::kMaxBytes);

enum class FunctionCode : std::uint8_t {
  kNoop = 1,
  kResetCounters = 2,
  kSetMode = 3,  // mode u8: 1 STANDBY, 2 RUN, 3 SAFE
  kResetSequence = 4,
  kModelLoad = 5,         // offset u32, 1...1024 bytes for the bank that is not in use
  kModelValidate = 6,     // size u32, CRC-32 u32 of the image's header, of what has been loaded
  kModelActivate = 7,     // CRC-32 u32, of what has been validated
  kModelDump = 8,         // bank u8, offset u32, size u16
  kSetLimit = 9,          // fsw::Limit u8, value u32
  kEnableResponse = 10,   // fsw::Fault u8
  kDisableResponse = 11,  // fsw::Fault u8
};

// Why a command was not carried out, in the order of the checks.
enum class CommandRefusal : std::uint8_t {
  kForged = 0,   // too short for a trailer, or its code is not the key's
  kReplayed,     // counter not higher than that of the last authentic command
  kMalformed,    // version, type, secondary header, flags, APID, or reserved field
  kWrongLength,  // the length field and what came, or the arguments and the function
  kWrongChecksum,
  kUnknownFunction,
  kWrongMode,      // not in this mode
  kWrongArgument,  // out of its range
  kNoModel,        // no model to run, validate or activate; the event says which gnc::ModelStatus
  kBusy,           // a dump of this cycle is already on its way
};
inline constexpr int kCommandRefusals = 10;

struct Telecommand {
  FunctionCode function = FunctionCode::kNoop;
  const std::uint8_t* arguments = nullptr;
  int argument_bytes = 0;

  std::uint8_t u8_at(int offset) const { return arguments[offset]; }
  std::uint16_t u16_at(int offset) const {
    return static_cast<std::uint16_t>(arguments[offset] << 8 | arguments[offset + 1]);
  }
  std::uint32_t u32_at(int offset) const { return std::uint32_t{u16_at(offset)} << 16 | u16_at(offset + 2); }
};

}  // namespace tumblesight::fsw
