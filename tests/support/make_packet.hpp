// Makes valid telecommand packets, which tests then damage.
#pragma once

#include <cstdint>
#include <vector>

#include "fsw/app/telecommand.hpp"
#include "hal/messages/command_key.hpp"
#include "hal/messages/command_packet.hpp"

namespace tumblesight::fsw {

inline constexpr hal::CommandKey kTestKey{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
inline constexpr hal::CommandKey kSecondTestKey{99, 98, 97, 96};
// Slots 0 and 1 hold the keys above, the others none.
inline constexpr hal::CommandKeys kTestKeys{{kTestKey, kSecondTestKey}, 0x2A5C};

// A packet with header, checksum and arguments, without a security trailer.
std::vector<std::uint8_t> packet_of(std::uint8_t function, const std::vector<std::uint8_t>& arguments = {});
// Sets the checksum to match the current content.
void set_checksum(std::vector<std::uint8_t>& packet);
struct Signature {
  hal::CommandKey key = kTestKey;
  std::uint8_t slot = 0;
  std::uint16_t spacecraft_id = kTestKeys.spacecraft_id;
  std::uint8_t reserved = 0;
};
// Adds the security trailer: length and checksum are adapted, and stay wrong where they were wrong.
hal::CommandPacket signed_as(const Signature& signature, std::uint32_t counter,
                             std::vector<std::uint8_t> packet);
hal::CommandPacket signed_with(const hal::CommandKey& key, std::uint32_t counter,
                               std::vector<std::uint8_t> packet);
hal::CommandPacket unsigned_packet(const std::vector<std::uint8_t>& packet);

// Big-endian.
void append_u16(std::vector<std::uint8_t>& bytes, std::uint16_t value);
void append_u32(std::vector<std::uint8_t>& bytes, std::uint32_t value);

}  // namespace tumblesight::fsw
