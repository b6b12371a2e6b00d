#include "fsw/app/command_handler.hpp"

#include "fsw/app/command_gate.hpp"
#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {
namespace {

bool is_set_mode_safe(const Telecommand& command) {
  return command.function == FunctionCode::kSetMode &&
         command.u8_at(0) == static_cast<std::uint8_t>(Mode::kSafe);
}

}  // namespace

void CommandHandler::run(const StepInputs& inputs) {
  count_dropped(inputs.commands_dropped);
  for (int i = 0; i < inputs.command_count; ++i) run(inputs.commands[static_cast<std::size_t>(i)]);
}

void CommandHandler::run(const hal::CommandPacket& packet) {
  AppState& state = context_.state;
  hal::Telemetry& counters = state.counters;
  const Mode before = state.mode;
  Admission admission = judge(packet, state.authority, counters.command_counter, before);
  if (admission.authentic) {
    counters.command_counter = admission.counter;
    const bool stored = context_.keeper.store_now();
    if (!stored && admission.admitted && !is_set_mode_safe(admission.command)) {
      admission.why = CommandRefusal::kNotStored;
      admission.admitted = false;
    }
  }
  Refusal refusal{admission.why, 0};
  if (admission.admitted && carry_out(admission.command, context_, refusal)) {
    count(counters.commands_accepted);
    context_.report(EventId::kCommandAccepted, admission.function, static_cast<std::int32_t>(before),
                    static_cast<std::int32_t>(state.mode));
    return;
  }
  count_refused(refusal.why, 1);
  context_.report(event_of(refusal.why), admission.function, packet.size, refusal.detail);
}

void CommandHandler::count_dropped(const hal::DroppedCommands& dropped) {
  for (std::size_t why = 0; why < dropped.by.size(); ++why) {
    if (dropped.by[why] == 0) continue;
    const auto reason = static_cast<CommandRefusal>(why);
    count_refused(reason, dropped.by[why]);
    context_.report(event_of(reason), 0, 0, clamp_to_int32(dropped.by[why]));
  }
}

void CommandHandler::count_refused(CommandRefusal why, std::uint32_t commands) {
  hal::Telemetry& counters = context_.state.counters;
  count(counters.commands_refused, commands);
  count(counters.commands_refused_by[static_cast<std::size_t>(why)], commands);
}

}  // namespace tumblesight::fsw
