// The table of telecommands: the rows of hal/messages/telecommands.inc, each with a handler in commands.cpp
// or model_commands.cpp.
#pragma once

#include <cstdint>

#include "fsw/app/app_state.hpp"
#include "fsw/app/mode_manager.hpp"
#include "fsw/app/model_manager.hpp"
#include "fsw/app/state_keeper.hpp"
#include "fsw/app/step_io.hpp"
#include "fsw/app/telecommand.hpp"

namespace tumblesight::fsw {

// What a handler may act on.
struct CommandContext {
  AppState& state;
  EventLog& events;
  ModeManager& modes;
  ModelManager& models;
  StateKeeper& keeper;
  StepOutputs& outputs;
  const Reporter& report;
};

// Why a command was refused. `detail`: third argument of the event, 0 where the refusal has none.
struct Refusal {
  CommandRefusal why = CommandRefusal::kForged;
  std::int32_t detail = 0;
};

inline bool refuse(Refusal& refusal, CommandRefusal why, std::int32_t detail = 0) {
  refusal = {why, detail};
  return false;
}

// The handlers of model_commands.cpp. False: the command is refused.
bool begin_model(const Telecommand& command, const CommandContext& context, Refusal& refusal);
bool load_model(const Telecommand& command, const CommandContext& context, Refusal& refusal);
bool validate_model(const Telecommand& command, const CommandContext& context, Refusal& refusal);
bool activate_model(const Telecommand& command, const CommandContext& context, Refusal& refusal);
// False: the bank cannot be read now, and the command is refused.
bool is_readable(std::uint32_t bank, const CommandContext& context, Refusal& refusal);

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
