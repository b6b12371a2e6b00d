#include "fsw/app/command_handler.hpp"

#include "fsw/app/command_gate.hpp"
#include "fsw/app/counter.hpp"

namespace tumblesight::fsw {

void CommandHandler::run(const StepInputs& inputs) {
  for (int i = 0; i < inputs.command_count; ++i) run(inputs.commands[static_cast<std::size_t>(i)]);
}

void CommandHandler::run(const hal::CommandPacket& packet) {
  AppState& state = context_.state;
  hal::Telemetry& counters = state.counters;
  const Mode before = state.mode;
  const Admission admission = judge(packet, state.command_key.key(), counters.command_counter, before);
  if (admission.authentic) counters.command_counter = admission.counter;
  Refusal refusal{admission.why, 0};
  if (admission.admitted && carry_out(admission.command, context_, refusal)) {
    count(counters.commands_accepted);
    context_.report(EventId::kCommandAccepted, admission.function, static_cast<std::int32_t>(before),
                    static_cast<std::int32_t>(state.mode));
    return;
  }
  count(counters.commands_refused);
  count(counters.commands_refused_by[static_cast<std::size_t>(refusal.why)]);
  context_.report(event_of(refusal.why), admission.function, packet.size, refusal.detail);
}

}  // namespace tumblesight::fsw
