#include "tests/support/make_packet.hpp"

#include <algorithm>

#include "fsw/app/hmac_sha256.hpp"
#include "gnc/numerics/crc16.hpp"

namespace tumblesight::fsw {

void append_u16(std::vector<std::uint8_t>& bytes, std::uint16_t value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

void append_u32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  append_u16(bytes, static_cast<std::uint16_t>(value >> 16));
  append_u16(bytes, static_cast<std::uint16_t>(value));
}

void set_checksum(std::vector<std::uint8_t>& packet) {
  packet[8] = packet[9] = 0;
  const std::uint16_t crc = gnc::crc16(packet.data(), packet.size());
  packet[8] = static_cast<std::uint8_t>(crc >> 8);
  packet[9] = static_cast<std::uint8_t>(crc);
}

std::vector<std::uint8_t> packet_of(std::uint8_t function, const std::vector<std::uint8_t>& arguments) {
  std::vector<std::uint8_t> packet{0x19, 0xF0, 0xC0, 0x00};
  append_u16(packet, static_cast<std::uint16_t>(3 + arguments.size()));
  packet.insert(packet.end(), {function, 0, 0, 0});
  packet.insert(packet.end(), arguments.begin(), arguments.end());
  set_checksum(packet);
  return packet;
}

hal::CommandPacket unsigned_packet(const std::vector<std::uint8_t>& bytes) {
  hal::CommandPacket packet;
  packet.size = static_cast<std::uint16_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), packet.bytes.begin());
  return packet;
}

hal::CommandPacket signed_with(const hal::CommandKey& key, std::uint32_t counter,
                               std::vector<std::uint8_t> packet) {
  append_u32(packet, counter);
  const Sha256Digest code = hmac_sha256(key, packet.data(), packet.size());
  packet.insert(packet.end(), code.begin(), code.begin() + hal::kCommandMacBytes);
  return unsigned_packet(packet);
}

}  // namespace tumblesight::fsw
