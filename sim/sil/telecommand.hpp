// Telecommands as the ground makes them: CCSDS space packets with a checksum, signed with HMAC-SHA-256
// (OpenSSL's, so that flight's own is held against another implementation). Bit by bit: docs/icd.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/link.hpp"

namespace tumblesight::sim {

struct Telecommand {
  std::uint8_t function = 0;
  std::vector<std::uint8_t> arguments;  // big-endian
};

Telecommand set_mode(std::uint8_t mode);
Telecommand reset_sequence();

// The key in a file: 64 hexadecimal digits and white space. Throws std::runtime_error that names the file
// otherwise.
std::array<std::uint8_t, 32> read_command_key(const std::string& path);

// Signs what it makes with a counter that rises from command to command.
class TelecommandEncoder {
 public:
  explicit TelecommandEncoder(const std::array<std::uint8_t, 32>& key) : key_(key) {}
  // Throws std::invalid_argument if the arguments do not fit a packet.
  hal::CommandPacket packet(const Telecommand& command);

 private:
  std::array<std::uint8_t, 32> key_;
  std::uint32_t counter_ = 0;
  std::uint16_t sequence_count_ = 0;  // 14 bits
};

}  // namespace tumblesight::sim
