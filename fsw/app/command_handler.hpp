// CommandHandler: checks, carries out, counts and reports the telecommands of a step.
#pragma once

#include "fsw/app/command_table.hpp"

namespace tumblesight::fsw {

class CommandHandler {
 public:
  explicit CommandHandler(const CommandContext& context) : context_(context) {}

  // All commands, in the order in which they arrived. Each one is counted as accepted or refused, with an
  // event. The counter of an authentic command is stored before the command is carried out. If it cannot be
  // stored, only SET_MODE SAFE is carried out: a replay of it after a reset does no harm. Commands that the
  // link has dropped are counted as refused, with one event per reason.
  void run(const StepInputs& inputs);

 private:
  void run(const hal::CommandPacket& packet);
  void count_dropped(const hal::DroppedCommands& dropped);
  void count_refused(CommandRefusal why, std::uint32_t commands);

  const CommandContext context_;
};

}  // namespace tumblesight::fsw
