// Whether a telecommand packet comes from the holder of the key, for this spacecraft, and for the first time.
// A link that queues commands asks before it queues one; the application asks again before it carries one
// out. Layout: hal/messages/command_packet.hpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gnc/numerics/hmac_sha256.hpp"
#include "hal/messages/command_key.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/command_refusal.hpp"

namespace tumblesight::hal {

struct CommandTrailer {
  std::uint16_t spacecraft_id = 0;
  std::uint8_t key_slot = 0;
  std::uint8_t reserved = 0;
  std::uint32_t counter = 0;
};

inline bool has_trailer(const CommandPacket& packet) {
  return packet.size >= kCommandHeaderBytes + kCommandTrailerBytes && packet.size <= packet.bytes.size();
}

// Requires has_trailer().
inline CommandTrailer trailer_of(const CommandPacket& packet) {
  const std::uint8_t* const at = packet.bytes.data() + packet.size - kCommandTrailerBytes;
  return {static_cast<std::uint16_t>(at[0] << 8 | at[1]), at[2], at[3],
          std::uint32_t{at[4]} << 24 | std::uint32_t{at[5]} << 16 | std::uint32_t{at[6]} << 8 | at[7]};
}

// The authentication code over a packet of `size_bytes` bytes, which ends where the code begins.
inline gnc::Sha256Digest command_code(const CommandKey& key, const std::uint8_t* packet,
                                      std::size_t size_bytes) {
  constexpr std::uint8_t kNoChecksum = 0;
  constexpr std::size_t kBehind = kCommandChecksumOffset + 1;
  gnc::HmacSha256 code(key);
  code.add(packet, kCommandChecksumOffset);
  code.add(&kNoChecksum, 1);
  code.add(packet + kBehind, size_bytes - kBehind);
  return code.digest();
}

struct CommandOrigin {
  bool authentic = false;
  CommandRefusal why = CommandRefusal::kForged;  // if not authentic
  std::uint32_t counter = 0;                     // if authentic
};

// `slot`: the key slot in use. `last_counter`: of the last authentic command.
inline CommandOrigin origin_of(const CommandPacket& packet, const CommandKeys& keys, std::uint32_t slot,
                               std::uint32_t last_counter) {
  const auto refused = [](CommandRefusal why) { return CommandOrigin{false, why, 0}; };
  if (!has_trailer(packet) || !keys.has_key(slot)) return refused(CommandRefusal::kForged);
  const CommandTrailer trailer = trailer_of(packet);
  if (trailer.key_slot != slot) return refused(CommandRefusal::kOtherKey);
  const std::size_t covered = static_cast<std::size_t>(packet.size) - kCommandMacBytes;
  const gnc::Sha256Digest code = command_code(keys.slots[slot], packet.bytes.data(), covered);
  if (!gnc::equal_in_constant_time(code.data(), packet.bytes.data() + covered, kCommandMacBytes))
    return refused(CommandRefusal::kForged);
  if (trailer.spacecraft_id != keys.spacecraft_id) return refused(CommandRefusal::kOtherSpacecraft);
  if (trailer.counter <= last_counter) return refused(CommandRefusal::kReplayed);
  if (trailer.counter - last_counter > kCommandWindow) return refused(CommandRefusal::kOutOfWindow);
  return {true, CommandRefusal::kForged, trailer.counter};
}

// What the holder of the key in `slot` shows in the telecommand KEY_ACTIVATE, before the slot is used: the
// first 16 bytes of the HMAC-SHA-256 of spacecraft id, slot, 0 and the telecommand's counter.
inline gnc::Sha256Digest proof_of_key(const CommandKeys& keys, std::uint8_t slot, std::uint32_t counter) {
  const std::uint8_t message[8] = {static_cast<std::uint8_t>(keys.spacecraft_id >> 8),
                                   static_cast<std::uint8_t>(keys.spacecraft_id),
                                   slot,
                                   0,
                                   static_cast<std::uint8_t>(counter >> 24),
                                   static_cast<std::uint8_t>(counter >> 16),
                                   static_cast<std::uint8_t>(counter >> 8),
                                   static_cast<std::uint8_t>(counter)};
  return gnc::hmac_sha256(keys.slots[slot], message, sizeof message);
}

}  // namespace tumblesight::hal
