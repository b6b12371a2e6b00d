// Telecommands for the tests: valid ones, which a test may then corrupt.
#pragma once

#include <cstdint>
#include <vector>

#include "fsw/app/telecommand.hpp"
#include "hal/command_key.hpp"

namespace tumblesight::fsw {

inline constexpr hal::CommandKey kTestKey{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

// Without a security trailer.
std::vector<std::uint8_t> packet_of(std::uint8_t function, const std::vector<std::uint8_t>& arguments = {});
// Sets the correct checksum, whatever the packet contains.
void set_checksum(std::vector<std::uint8_t>& packet);
hal::CommandPacket signed_with(const hal::CommandKey& key, std::uint32_t counter,
                               std::vector<std::uint8_t> packet);
hal::CommandPacket unsigned_packet(const std::vector<std::uint8_t>& packet);

// Big-endian.
void append_u16(std::vector<std::uint8_t>& bytes, std::uint16_t value);
void append_u32(std::vector<std::uint8_t>& bytes, std::uint32_t value);

}  // namespace tumblesight::fsw
