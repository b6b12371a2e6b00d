// Command gate: the checks that a command packet must pass before it is carried out. Nothing in a packet is
// used before its authentication code has been checked.
#pragma once

#include <cstdint>

#include "fsw/app/command_authority.hpp"
#include "fsw/app/modes.hpp"
#include "fsw/app/telecommand.hpp"

namespace tumblesight::fsw {

struct Admission {
  bool admitted = false;
  CommandRefusal why = CommandRefusal::kForged;  // if not admitted
  std::uint8_t function = 0;                     // 0 if the packet's function code cannot be trusted
  bool authentic = false;                        // if true, `counter` is spent, even if the packet is refused
  std::uint32_t counter = 0;
  Telecommand command;  // if admitted; points into the packet
};

// Where the authority has no keys, the link authenticates commands and there is no trailer. `last_counter`:
// counter of the last authentic command.
Admission judge(const hal::CommandPacket& packet, const CommandAuthority& authority,
                std::uint32_t last_counter, Mode mode);

}  // namespace tumblesight::fsw
