// CommandPacket: a telecommand as received. A CCSDS space packet (CCSDS 133.0-B) with a secondary header,
// followed by the security trailer. All numbers are big-endian. Bit by bit: docs/icd.md.
//
//   offset  bytes  field
//        0      2  packet version 0 (3 bits), type 1 (1), secondary header flag 1 (1), APID 0x1F0 (11)
//        2      2  sequence flags 3 (2 bits), sequence count (14)
//        4      2  data length: number of bytes from offset 6 to the end of the packet, minus one
//        6      1  function code
//        7      1  reserved, 0
//        8      2  checksum: CRC-16/CCITT (0x1021, from 0xFFFF) over the packet with 0 in this field
//       10      n  arguments
//   10 + n      4  trailer: counter, higher than in every command accepted before
//   14 + n     16  trailer: first 16 bytes of HMAC-SHA-256 over everything before them
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

inline constexpr std::uint16_t kCommandApid = 0x1F0;
inline constexpr int kCommandHeaderBytes = 10;
inline constexpr int kCommandTrailerBytes = 20;
inline constexpr int kCommandMacBytes = 16;  // of the trailer
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

}  // namespace tumblesight::hal
