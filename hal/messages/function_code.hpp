// Function codes of the telecommands, 7 bits. The numbers are part of the interface (docs/icd.md);
// fsw/app/commands.cpp has each function's arguments, modes and handler.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

enum class FunctionCode : std::uint8_t {
  kNoop = 1,
  kResetCounters = 2,
  kSetMode = 3,
  kResetSequence = 4,
  kModelLoad = 5,
  kModelValidate = 6,
  kModelActivate = 7,
  kMemoryDump = 8,
  kSetParameter = 9,
  kEnableResponse = 10,
  kDisableResponse = 11,
  kKeyActivate = 12,
  kModelBegin = 13,
  kTableLoad = 14,
  kTableValidate = 15,
  kTableActivate = 16,
};

}  // namespace tumblesight::hal
