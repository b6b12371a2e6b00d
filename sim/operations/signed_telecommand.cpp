#include "sim/operations/signed_telecommand.hpp"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "sim/host/input_file.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kTelecommandWithSecondaryHeader = 0x1800;
constexpr std::uint32_t kUnsegmented = 0xC000;

void append(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace

Telecommand set_mode(hal::Mode mode) {
  return {hal::FunctionCode::kSetMode, {static_cast<std::uint8_t>(mode)}};
}

Telecommand reset_sequence() {
  return {hal::FunctionCode::kResetSequence, {}};
}

hal::CommandKey read_command_key(const std::string& path) {
  constexpr InputKind kKeyFile{"command key", 4096};
  std::string digits;
  for (const char c : read_text(path, kKeyFile)) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) digits += c;
  }
  hal::CommandKey key{};
  const bool complete = digits.size() == 2 * key.size() &&
                        digits.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  if (!complete) {
    throw std::runtime_error("command key '" + path + "' holds " + std::to_string(digits.size()) +
                             " characters; expected 64 hexadecimal digits and nothing else");
  }
  for (std::size_t i = 0; i < key.size(); ++i) {
    key[i] = static_cast<std::uint8_t>(std::stoul(digits.substr(2 * i, 2), nullptr, 16));
  }
  return key;
}

hal::CommandPacket TelecommandEncoder::packet(const Telecommand& command) {
  const std::size_t size = hal::kCommandHeaderBytes + command.arguments.size() + hal::kCommandTrailerBytes;
  if (size > hal::CommandPacket::kMaxBytes) {
    throw std::invalid_argument("a telecommand of " + std::to_string(size) + " bytes; at most " +
                                std::to_string(hal::CommandPacket::kMaxBytes));
  }
  std::vector<std::uint8_t> bytes;
  append(bytes, kTelecommandWithSecondaryHeader | hal::kCommandApid, 2);
  append(bytes, kUnsegmented | sequence_count_, 2);
  append(bytes, static_cast<std::uint32_t>(size - hal::kCommandPrimaryHeaderBytes - 1), 2);
  append(bytes, static_cast<std::uint32_t>(command.function), 1);
  append(bytes, 0, 1);  // the checksum, which the authentication code leaves out
  bytes.insert(bytes.end(), command.arguments.begin(), command.arguments.end());
  append(bytes, spacecraft_id_, 2);
  append(bytes, key_slot_, 1);
  append(bytes, 0, 1);
  append(bytes, ++counter_, 4);
  sequence_count_ = static_cast<std::uint16_t>((sequence_count_ + 1) & 0x3FFF);

  std::array<std::uint8_t, EVP_MAX_MD_SIZE> code{};
  HMAC(EVP_sha256(), key_.data(), static_cast<int>(key_.size()), bytes.data(), bytes.size(), code.data(),
       nullptr);
  bytes.insert(bytes.end(), code.begin(), code.begin() + hal::kCommandMacBytes);
  bytes[hal::kCommandChecksumOffset] = hal::command_checksum(bytes.data(), bytes.size());

  hal::CommandPacket packet;
  packet.size = static_cast<std::uint16_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), packet.bytes.begin());
  return packet;
}

}  // namespace tumblesight::sim
