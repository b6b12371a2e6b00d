#include "sim/sil/telecommand.hpp"

#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <stdexcept>
#include <string>

#include "gnc/numerics/crc16.hpp"
#include "hal/dds/idl/tumblesight.h"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kHeaderBytes = 10;
constexpr std::size_t kPrimaryHeaderBytes = 6;
constexpr std::size_t kMacBytes = 16;
constexpr std::size_t kTrailerBytes = 4 + kMacBytes;

void append(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

}  // namespace

Telecommand set_mode(std::uint8_t mode) {
  return {tumblesight_icd_FUNCTION_SET_MODE, {mode}};
}
Telecommand reset_sequence() {
  return {tumblesight_icd_FUNCTION_RESET_SEQUENCE, {}};
}

std::array<std::uint8_t, 32> read_command_key(const std::string& path) {
  std::ifstream file(path);
  std::string digits;
  for (char c; file.get(c);) {
    if (std::isspace(static_cast<unsigned char>(c)) == 0) digits += c;
  }
  std::array<std::uint8_t, 32> key{};
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
  const std::size_t size = kHeaderBytes + command.arguments.size();
  if (size + kTrailerBytes > hal::CommandPacket::kMaxBytes) {
    throw std::invalid_argument("a telecommand of " + std::to_string(size + kTrailerBytes) +
                                " bytes; at most " + std::to_string(hal::CommandPacket::kMaxBytes));
  }
  std::vector<std::uint8_t> bytes;
  append(bytes, 0x1800U | tumblesight_icd_COMMAND_APID, 2);
  append(bytes, 0xC000U | sequence_count_, 2);
  append(bytes, static_cast<std::uint32_t>(size - kPrimaryHeaderBytes - 1), 2);
  append(bytes, command.function, 1);
  append(bytes, 0, 3);
  bytes.insert(bytes.end(), command.arguments.begin(), command.arguments.end());
  const std::uint16_t crc = gnc::crc16(bytes.data(), bytes.size());
  bytes[8] = static_cast<std::uint8_t>(crc >> 8);
  bytes[9] = static_cast<std::uint8_t>(crc);
  append(bytes, ++counter_, 4);
  sequence_count_ = static_cast<std::uint16_t>((sequence_count_ + 1) & 0x3FFF);

  std::array<std::uint8_t, EVP_MAX_MD_SIZE> code{};
  HMAC(EVP_sha256(), key_.data(), static_cast<int>(key_.size()), bytes.data(), bytes.size(), code.data(),
       nullptr);
  bytes.insert(bytes.end(), code.begin(), code.begin() + kMacBytes);

  hal::CommandPacket packet;
  packet.size = static_cast<std::uint16_t>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), packet.bytes.begin());
  return packet;
}

}  // namespace tumblesight::sim
