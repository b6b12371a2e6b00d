// The keys for the authentication code of telecommands (HMAC-SHA-256, hal/messages/command_packet.hpp).
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

using CommandKey = std::array<std::uint8_t, 32>;

inline constexpr int kCommandKeySlots = 4;

// The keys that were loaded before launch, and the spacecraft that they command. One slot is in use; the
// telecommand KEY_ACTIVATE selects another one.
struct CommandKeys {
  std::array<CommandKey, kCommandKeySlots> slots{};  // a key of zeros: the slot is empty
  std::uint16_t spacecraft_id = 0;

  bool has_key(std::uint32_t slot) const { return slot < slots.size() && slots[slot] != CommandKey{}; }
};

}  // namespace tumblesight::hal
