// Function codes of the telecommands, 7 bits, generated from the rows of telecommands.inc.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class FunctionCode : std::uint8_t {
#define TUMBLESIGHT_TELECOMMAND(code, name, modes, ...) k##name = (code),
#include "hal/messages/telecommands.inc"
#undef TUMBLESIGHT_TELECOMMAND
};

}  // namespace tumblesight::hal
