// TelemetryEncoder: the messages of the application as CCSDS space packets (CCSDS 133.0-B-2), for links that
// carry packets. All numbers are big-endian, signed ones in two's complement; nothing is padded.
//
//   offset  bytes  field
//        0      2  packet version 0 (3 bits), type 0 (1), secondary header flag 1 (1), APID (11)
//        2      2  sequence flags 3 (2 bits), sequence count (14)
//        4      2  data length: number of bytes from offset 6 to the end of the packet, minus one
//        6      8  time: CUC (CCSDS 301.0-B-4), 4 bytes of seconds and 4 bytes of fractions of a second
//       14      n  all fields of the message, in the order of its structure
//   14 + n      2  error control: CRC-16/CCITT (0x1021, from 0xFFFF) over everything before it
//
// The time is the message's cycle time. Its epoch is that of the platform's clock. There is no P-field: the
// format is fixed. Fractions count 2^-32 s, rounded to the nearest, so the nanoseconds can be recovered.
// Times before the epoch are shown as 0 and times that need more than 32 bits of seconds as the largest
// value; the message's own field time_ns, in nanoseconds, has no such limits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "hal/messages/message_fields.hpp"

namespace tumblesight::hal::packets {

// Application process identifiers, one per kind of packet.
struct PacketApids {
  std::uint16_t attitude_report = 0x1F1;
  std::uint16_t telemetry = 0x1F2;
  std::uint16_t event = 0x1F3;
  std::uint16_t memory_dump = 0x1F4;
};

inline constexpr std::uint16_t kMaxApid = 0x7FE;  // 0x7FF: idle packets

// Whether all are in range and no two are equal: each APID has its own sequence count.
bool are_valid(const PacketApids& apids);

inline constexpr int kPrimaryHeaderBytes = 6;
inline constexpr int kTimeBytes = 8;
inline constexpr int kErrorControlBytes = 2;

namespace detail {

struct FieldBytes {
  std::size_t sum = 0;

  template <class Field>
  constexpr void operator()(const Field&) {
    sum += sizeof(Field);
  }
};

}  // namespace detail

// Size of the packet that carries a message.
template <class Message>
constexpr std::size_t packet_bytes() {
  detail::FieldBytes fields;
  const Message message{};
  MessageFields<Message>::visit(fields, message);
  return kPrimaryHeaderBytes + kTimeBytes + fields.sum + kErrorControlBytes;
}

struct TelemetryPacket {
  static constexpr std::size_t kMaxBytes = packet_bytes<MemoryDump>();
  std::uint16_t size = 0;
  std::array<std::uint8_t, kMaxBytes> bytes{};
};

class TelemetryEncoder {
 public:
  // Requires valid APIDs.
  explicit TelemetryEncoder(const PacketApids& apids = {}) : apids_(apids) {}

  // The packet is valid until the next call. The sequence count of its APID then goes on, modulo 2^14.
  const TelemetryPacket& encode(const AttitudeReport& report);
  const TelemetryPacket& encode(const Telemetry& telemetry);
  const TelemetryPacket& encode(const Event& event);
  const TelemetryPacket& encode(const MemoryDump& dump);

 private:
  struct SequenceCounts {
    std::uint16_t attitude_report = 0;
    std::uint16_t telemetry = 0;
    std::uint16_t event = 0;
    std::uint16_t memory_dump = 0;
  };

  PacketApids apids_;
  SequenceCounts counts_;
  TelemetryPacket packet_;
};

}  // namespace tumblesight::hal::packets
