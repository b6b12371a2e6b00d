// The key of the telecommands' authentication code.
#pragma once

#include <array>
#include <cstdint>

namespace tumblesight::hal {

using CommandKey = std::array<std::uint8_t, 32>;

}  // namespace tumblesight::hal
