// CommandHandler: checks, carries out, counts and reports the telecommands of a step.
#pragma once

#include "fsw/app/command_table.hpp"

namespace tumblesight::fsw {

class CommandHandler {
 public:
  explicit CommandHandler(const CommandContext& context) : context_(context) {}

  // All commands, in the order in which they arrived. Each one is counted as accepted or refused, with an
  // event.
  void run(const StepInputs& inputs);

 private:
  void run(const hal::CommandPacket& packet);

  const CommandContext context_;
};

}  // namespace tumblesight::fsw
