// A receiver of CCSDS space packets, written from CCSDS 133.0-B-2 (4.1) and from the command header of cFS
// alone. It uses nothing of the project, so that a mistake in a packet's layout shows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumblesight::standard {

struct SpacePacket {
  int version = 0, type = 0, secondary_header = 0, apid = 0, sequence_flags = 0, sequence_count = 0;
  std::vector<std::uint8_t> data_field;  // everything behind the primary header
  std::vector<std::uint8_t> whole;

  // The command secondary header of cFS: a reserved bit, 7 bits function code, 8 bits checksum.
  int cfs_reserved() const { return data_field[0] >> 7; }
  int cfs_function() const { return data_field[0] & 0x7F; }
  // CFE_MSG_ValidateChecksum.
  bool cfs_checksum_is_valid() const {
    std::uint8_t sum = 0xFF;
    for (const std::uint8_t byte : whole) sum = static_cast<std::uint8_t>(sum ^ byte);
    return sum == 0;
  }
};

// Cuts a stream into packets by their length fields. A rest that is no whole packet is left out.
inline std::vector<SpacePacket> depacketize(const std::vector<std::uint8_t>& stream) {
  std::vector<SpacePacket> packets;
  std::size_t at = 0;
  while (at + 7 <= stream.size()) {
    const std::uint8_t* const header = stream.data() + at;
    const std::size_t data_bytes = static_cast<std::size_t>(header[4] * 256 + header[5]) + 1;  // 4.1.3.5.3
    if (at + 6 + data_bytes > stream.size()) break;
    SpacePacket packet;
    packet.version = header[0] >> 5;
    packet.type = header[0] >> 4 & 1;
    packet.secondary_header = header[0] >> 3 & 1;
    packet.apid = (header[0] & 7) * 256 + header[1];
    packet.sequence_flags = header[2] >> 6;
    packet.sequence_count = (header[2] & 0x3F) * 256 + header[3];
    packet.data_field.assign(header + 6, header + 6 + data_bytes);
    packet.whole.assign(header, header + 6 + data_bytes);
    packets.push_back(packet);
    at += 6 + data_bytes;
  }
  return packets;
}

}  // namespace tumblesight::standard
