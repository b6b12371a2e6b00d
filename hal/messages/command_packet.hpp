// CommandPacket: a telecommand as received. A CCSDS space packet (CCSDS 133.0-B) with the secondary header
// that cFS uses for commands; the security trailer is part of the packet's data field. All numbers are
// big-endian. Bit by bit: docs/icd.md.
//
//   offset  bytes  field
//        0      2  packet version 0 (3 bits), type 1 (1), secondary header flag 1 (1), APID (11): 0x1F0
//                  unless the platform has another one
//        2      2  sequence flags 3 (2 bits), sequence count (14)
//        4      2  data length: number of bytes from offset 6 to the end of the trailer, minus one
//        6      1  reserved, 0 (1 bit), function code (7)
//        7      1  checksum: the exclusive or of all bytes of the packet, this one included, is 0xFF
//        8      n  arguments
//    8 + n      2  trailer: spacecraft id
//   10 + n      1  trailer: key slot that signs this packet
//   11 + n      1  trailer: reserved, 0
//   12 + n      4  trailer: counter, 1...65,536 higher than in the last authentic command
//   16 + n     16  trailer: first 16 bytes of HMAC-SHA-256 over everything before them, with 0 as checksum
//
// Where the link authenticates commands itself there is no trailer: the packet is a plain cFS command.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::hal {

inline constexpr std::uint16_t kCommandApid = 0x1F0;
inline constexpr int kCommandPrimaryHeaderBytes = 6;
inline constexpr int kCommandFunctionOffset = 6;
inline constexpr int kCommandChecksumOffset = 7;
inline constexpr int kCommandHeaderBytes = 8;
inline constexpr int kCommandTrailerBytes = 24;
inline constexpr int kCommandMacBytes = 16;  // of the trailer
inline constexpr std::uint32_t kCommandWindow = 65'536;
inline constexpr int kMaxModelSegmentBytes = 1024;
inline constexpr int kMaxCommandArgumentBytes = 4 + kMaxModelSegmentBytes;

struct CommandPacket {
  static constexpr int kMaxBytes = 1060;
  // May exceed kMaxBytes for a packet that was too large; the application then refuses it.
  std::uint16_t size = 0;
  std::array<std::uint8_t, kMaxBytes> bytes{};
};
static_assert(kCommandHeaderBytes + kMaxCommandArgumentBytes + kCommandTrailerBytes <=
              CommandPacket::kMaxBytes);

// The checksum of cFS (CFE_MSG_ComputeCheckSum): 0 over a whole packet with a correct checksum; over a packet
// with 0 in this field, the value for the field.
constexpr std::uint8_t command_checksum(const std::uint8_t* packet, std::size_t size_bytes) {
  std::uint8_t checksum = 0xFF;
  for (std::size_t i = 0; i < size_bytes; ++i) checksum = static_cast<std::uint8_t>(checksum ^ packet[i]);
  return checksum;
}

}  // namespace tumblesight::hal
