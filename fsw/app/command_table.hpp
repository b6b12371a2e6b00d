// The table of telecommands. Each telecommand has one row and one handler in commands.cpp. The table
// of commands in docs/icd.md is generated from the rows.
#pragma once

#include <cstdint>

#include "fsw/app/app_state.hpp"
#include "fsw/app/mode_manager.hpp"
#include "fsw/app/model_manager.hpp"
#include "fsw/app/step_io.hpp"
#include "fsw/app/telecommand.hpp"

namespace tumblesight::fsw {

// What a handler may act on.
struct CommandContext {
  AppState& state;
  EventLog& events;
  ModeManager& modes;
  ModelManager& models;
  StepOutputs& outputs;
  const Reporter& report;
};

// Why a command was refused. `detail`: third argument of the event, 0 where the refusal has none.
struct Refusal {
  CommandRefusal why = CommandRefusal::kForged;
  std::int32_t detail = 0;
};

// What the command gate checks before a command is carried out.
struct CommandRule {
  FunctionCode function;
  int min_argument_bytes;
  int max_argument_bytes;
  std::uint8_t modes;  // bit n: allowed in Mode n

  bool allowed_in(Mode mode) const { return is_mode(mode) && (modes >> static_cast<int>(mode) & 1) != 0; }
};

// nullptr: the table has no such function.
const CommandRule* find_command(std::uint8_t function);

// Carries out a command that has passed the gate. False: refused; `refusal` is set and nothing was changed.
bool carry_out(const Telecommand& command, const CommandContext& context, Refusal& refusal);

}  // namespace tumblesight::fsw
