#include "fsw/app/command_gate.hpp"

#include "fsw/app/command_table.hpp"
#include "hal/command_authentication.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint16_t kTelecommand = 0x1800;  // version 0, telecommand, secondary header
constexpr int kLengthOffset = 4;

std::uint16_t u16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] << 8 | at[1]);
}

bool is_well_formed(const std::uint8_t* packet, std::uint16_t apid) {
  constexpr int kUnsegmented = 3, kReservedBit = 0x80;
  return u16(packet) == (kTelecommand | apid) && packet[2] >> 6 == kUnsegmented &&
         (packet[hal::kCommandFunctionOffset] & kReservedBit) == 0;
}

// The checks of an authentic packet. `trailer_bytes`: at the end of the packet.
bool refuses(const hal::CommandPacket& packet, std::uint16_t apid, int trailer_bytes, Mode mode,
             Admission& admission) {
  const auto refused = [&admission](CommandRefusal why) {
    admission.why = why;
    return true;
  };
  const std::uint8_t* const bytes = packet.bytes.data();
  if (packet.size < hal::kCommandHeaderBytes || !is_well_formed(bytes, apid))
    return refused(CommandRefusal::kMalformed);
  admission.function = bytes[hal::kCommandFunctionOffset];
  if (u16(bytes + kLengthOffset) != packet.size - hal::kCommandPrimaryHeaderBytes - 1)
    return refused(CommandRefusal::kWrongLength);
  if (hal::command_checksum(bytes, packet.size) != 0) return refused(CommandRefusal::kWrongChecksum);
  const CommandRule* rule = find_command(admission.function);
  if (rule == nullptr) return refused(CommandRefusal::kUnknownFunction);
  const int arguments = packet.size - hal::kCommandHeaderBytes - trailer_bytes;
  if (arguments < rule->min_argument_bytes || arguments > rule->max_argument_bytes)
    return refused(CommandRefusal::kWrongLength);
  if (!rule->allowed_in(mode)) return refused(CommandRefusal::kWrongMode);
  admission.command = {rule->function, bytes + hal::kCommandHeaderBytes, arguments};
  return false;
}

// The checks of the trailer. True: the packet is authentic and its counter is spent.
bool takes_trailer(const hal::CommandPacket& packet, const hal::CommandKeys& keys, std::uint32_t slot,
                   std::uint32_t last_counter, Admission& admission) {
  const hal::CommandOrigin origin = hal::origin_of(packet, keys, slot, last_counter);
  admission.why = origin.why;
  admission.authentic = origin.authentic;
  admission.counter = origin.counter;
  if (!origin.authentic) return false;
  if (hal::trailer_of(packet).reserved == 0) return true;
  admission.why = CommandRefusal::kMalformed;
  return false;
}

}  // namespace

Admission judge(const hal::CommandPacket& packet, const CommandAuthority& authority,
                std::uint32_t last_counter, Mode mode) {
  Admission admission;
  const hal::CommandKeys* const keys = authority.keys();
  if (keys != nullptr) {
    if (!takes_trailer(packet, *keys, authority.slot(), last_counter, admission)) return admission;
    admission.admitted = !refuses(packet, authority.apid(), hal::kCommandTrailerBytes, mode, admission);
  } else if (packet.size > packet.bytes.size()) {
    admission.why = CommandRefusal::kWrongLength;
  } else {
    admission.admitted = !refuses(packet, authority.apid(), 0, mode, admission);
  }
  return admission;
}

}  // namespace tumblesight::fsw
