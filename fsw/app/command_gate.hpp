// CommandGate: what a packet must be before the application looks at what it asks for. Nothing of a packet is
// believed before its authentication code has been checked.
#pragma once

#include <cstdint>

#include "fsw/app/modes.hpp"
#include "fsw/app/telecommand.hpp"
#include "hal/command_key.hpp"

namespace tumblesight::fsw {

// What a function takes, and in which modes.
struct CommandRule {
  FunctionCode function;
  int least_bytes;  // of arguments
  int most_bytes;
  std::uint8_t modes;  // bit n: the mode of number n
};
inline constexpr std::uint8_t kInStandby = 1U << static_cast<int>(Mode::kStandby);
inline constexpr std::uint8_t kInRun = 1U << static_cast<int>(Mode::kRun);
inline constexpr std::uint8_t kInSafe = 1U << static_cast<int>(Mode::kSafe);
inline constexpr std::uint8_t kAlways = kInStandby | kInRun | kInSafe;

// Checking a whole image takes too long beside an estimate, hence not in RUN.
inline constexpr std::array<CommandRule, 11> kCommandRules{{
    {FunctionCode::kNoop, 0, 0, kAlways},
    {FunctionCode::kResetCounters, 0, 0, kAlways},
    {FunctionCode::kSetMode, 1, 1, kAlways},
    {FunctionCode::kResetSequence, 0, 0, kInStandby | kInRun},
    {FunctionCode::kModelLoad, 5, kMaxCommandArgumentBytes, kAlways},
    {FunctionCode::kModelValidate, 8, 8, kInStandby | kInSafe},
    {FunctionCode::kModelActivate, 4, 4, kInStandby | kInSafe},
    {FunctionCode::kModelDump, 7, 7, kAlways},
    {FunctionCode::kSetLimit, 5, 5, kAlways},
    {FunctionCode::kEnableResponse, 1, 1, kAlways},
    {FunctionCode::kDisableResponse, 1, 1, kAlways},
}};

struct Admission {
  bool admitted = false;
  CommandRefusal why = CommandRefusal::kForged;  // if not admitted
  std::uint8_t function = 0;                     // 0 where nothing of the packet is to be believed
  bool authentic = false;  // then `counter` is to be remembered, whatever became of the rest
  std::uint32_t counter = 0;
  Telecommand command;  // points into the packet
};

// `key`: nullptr where the link beneath authenticates; then there is no trailer. `last_counter`: of the last
// authentic command.
Admission judge(const hal::CommandPacket& packet, const hal::CommandKey* key, std::uint32_t last_counter,
                Mode mode);

}  // namespace tumblesight::fsw
