#include "fsw/app/command_gate.hpp"

#include "fsw/app/command_table.hpp"
#include "fsw/app/hmac_sha256.hpp"
#include "gnc/numerics/crc16.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint16_t kPacketIdentification =
    0x1800 | hal::kCommandApid;  // version 0, telecommand, secondary header
constexpr int kLengthOffset = 4, kFunctionOffset = 6, kReservedOffset = 7, kChecksumOffset = 8;
constexpr int kPrimaryHeaderBytes = 6;

std::uint16_t u16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] << 8 | at[1]);
}
std::uint32_t u32(const std::uint8_t* at) {
  return std::uint32_t{u16(at)} << 16 | u16(at + 2);
}

bool is_authentic(const hal::CommandPacket& packet, const hal::CommandKey& key) {
  const std::size_t size = packet.size;
  if (size < hal::kCommandTrailerBytes || size > packet.bytes.size()) return false;
  const std::size_t covered = size - hal::kCommandMacBytes;
  const Sha256Digest code = hmac_sha256(key, packet.bytes.data(), covered);
  return equal_in_constant_time(code.data(), packet.bytes.data() + covered, hal::kCommandMacBytes);
}

bool is_well_formed(const std::uint8_t* packet) {
  constexpr int kUnsegmented = 3;
  return u16(packet) == kPacketIdentification && packet[2] >> 6 == kUnsegmented &&
         packet[kReservedOffset] == 0;
}

bool has_checksum(const std::uint8_t* packet, int size) {
  // The checksum is computed with 0 in its own field.
  std::uint16_t crc = gnc::crc16(packet, kChecksumOffset);
  crc = gnc::crc16_append(crc, 0);
  crc = gnc::crc16_append(crc, 0);
  for (int i = hal::kCommandHeaderBytes; i < size; ++i) crc = gnc::crc16_append(crc, packet[i]);
  return crc == u16(packet + kChecksumOffset);
}

// The checks of an authentic packet. `size`: without the trailer.
bool refuses(const std::uint8_t* packet, int size, Mode mode, Admission& admission) {
  const auto refused = [&admission](CommandRefusal why) {
    admission.why = why;
    return true;
  };
  if (size < hal::kCommandHeaderBytes || !is_well_formed(packet)) return refused(CommandRefusal::kMalformed);
  admission.function = packet[kFunctionOffset];
  if (u16(packet + kLengthOffset) != size - kPrimaryHeaderBytes - 1)
    return refused(CommandRefusal::kWrongLength);
  if (!has_checksum(packet, size)) return refused(CommandRefusal::kWrongChecksum);
  const CommandRule* rule = find_command(admission.function);
  if (rule == nullptr) return refused(CommandRefusal::kUnknownFunction);
  const int arguments = size - hal::kCommandHeaderBytes;
  if (arguments < rule->min_argument_bytes || arguments > rule->max_argument_bytes)
    return refused(CommandRefusal::kWrongLength);
  if (!rule->allowed_in(mode)) return refused(CommandRefusal::kWrongMode);
  admission.command = {rule->function, packet + hal::kCommandHeaderBytes, arguments};
  return false;
}

}  // namespace

Admission judge(const hal::CommandPacket& packet, const hal::CommandKey* key, std::uint32_t last_counter,
                Mode mode) {
  Admission admission;
  int size = packet.size;
  if (key != nullptr) {
    if (!is_authentic(packet, *key)) return admission;
    size -= hal::kCommandTrailerBytes;
    admission.counter = u32(packet.bytes.data() + size);
    if (admission.counter <= last_counter) {
      admission.why = CommandRefusal::kReplayed;
      return admission;
    }
    admission.authentic = true;
  } else if (packet.size > packet.bytes.size()) {
    admission.why = CommandRefusal::kWrongLength;
    return admission;
  }
  admission.admitted = !refuses(packet.bytes.data(), size, mode, admission);
  return admission;
}

}  // namespace tumblesight::fsw
