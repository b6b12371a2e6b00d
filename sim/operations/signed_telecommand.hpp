// Telecommands as the ground makes them: CCSDS space packets as cFS uses them, signed with HMAC-SHA-256. The
// ground uses OpenSSL's HMAC, so that each run compares the flight side's HMAC with another implementation.
// Format: hal/messages/command_packet.hpp, docs/icd.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/messages/command_key.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/function_code.hpp"
#include "hal/messages/mode.hpp"

namespace tumblesight::sim {

struct Telecommand {
  hal::FunctionCode function = hal::FunctionCode::kNoop;
  std::vector<std::uint8_t> arguments;  // big-endian
};

Telecommand set_mode(hal::Mode mode);
Telecommand reset_sequence();

// Reads a key file: 64 hexadecimal digits, with any white space. Throws std::runtime_error with the file name
// for any other content.
hal::CommandKey read_command_key(const std::string& path);

// Makes signed packets. The counter of the trailer and the sequence count increase with each packet.
class TelecommandEncoder {
 public:
  explicit TelecommandEncoder(const hal::CommandKey& key) : key_(key) {}
  // The next packet has the counter after this one, which is the command_counter of the telemetry.
  void continue_after(std::uint32_t counter) { counter_ = counter; }
  // Throws std::invalid_argument if the arguments do not fit into a packet.
  hal::CommandPacket packet(const Telecommand& command);

 private:
  hal::CommandKey key_;
  std::uint8_t key_slot_ = 0;
  std::uint16_t spacecraft_id_ = 0;
  std::uint32_t counter_ = 0;
  std::uint16_t sequence_count_ = 0;  // 14 bits
};

}  // namespace tumblesight::sim
