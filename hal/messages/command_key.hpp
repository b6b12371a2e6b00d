// The key for the authentication code of telecommands (HMAC-SHA-256, hal/messages/command_packet.hpp).
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

using CommandKey = std::array<std::uint8_t, 32>;

}  // namespace tumblesight::hal
