#include "tests/support/make_packet.hpp"

#include <algorithm>
#include <utility>

#include "hal/command_authentication.hpp"

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
  packet[7] = 0;
  packet[7] = hal::command_checksum(packet.data(), packet.size());
}

std::vector<std::uint8_t> packet_of(std::uint8_t function, const std::vector<std::uint8_t>& arguments) {
  std::vector<std::uint8_t> packet{0x19, 0xF0, 0xC0, 0x00};
  append_u16(packet, static_cast<std::uint16_t>(1 + arguments.size()));
  packet.insert(packet.end(), {function, 0});
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

hal::CommandPacket signed_as(const Signature& signature, std::uint32_t counter,
                             std::vector<std::uint8_t> packet) {
  const std::uint8_t fault = hal::command_checksum(packet.data(), packet.size());
  const int length = (packet[4] << 8 | packet[5]) + hal::kCommandTrailerBytes;
  packet[4] = static_cast<std::uint8_t>(length >> 8);
  packet[5] = static_cast<std::uint8_t>(length);
  append_u16(packet, signature.spacecraft_id);
  packet.insert(packet.end(), {signature.slot, signature.reserved});
  append_u32(packet, counter);
  const gnc::Sha256Digest code = hal::command_code(signature.key, packet.data(), packet.size());
  packet.insert(packet.end(), code.begin(), code.begin() + hal::kCommandMacBytes);
  set_checksum(packet);
  packet[7] ^= fault;
  return unsigned_packet(packet);
}

hal::CommandPacket signed_with(const hal::CommandKey& key, std::uint32_t counter,
                               std::vector<std::uint8_t> packet) {
  Signature signature;
  signature.key = key;
  return signed_as(signature, counter, std::move(packet));
}

}  // namespace tumblesight::fsw
