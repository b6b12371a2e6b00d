#include "fsw/app/cycle.hpp"

namespace tumblesight::fsw {
namespace {

void receive_frames(hal::Lidar& lidar, CycleWorkspace& workspace) {
  StepInputs& inputs = workspace.inputs;
  inputs.frame_count = 0;
  inputs.frame_wrong_size = 0;
  for (int i = 0; i < config::kMaxFramesPerStep; ++i) {
    const hal::LidarStatus status =
        lidar.receive(workspace.frames[static_cast<std::size_t>(inputs.frame_count)]);
    if (status == hal::LidarStatus::kNoFrame) break;
    if (status == hal::LidarStatus::kFrame) ++inputs.frame_count;
    if (status == hal::LidarStatus::kWrongSize) ++inputs.frame_wrong_size;
  }
  inputs.frame = inputs.frame_count > 0 ? workspace.frames.data() : nullptr;
}

void receive_commands(hal::Link& link, StepInputs& inputs) {
  inputs.commands_dropped = link.take_dropped();
  inputs.command_count = 0;
  for (hal::CommandPacket& command : inputs.commands) {
    if (!link.receive(command)) break;
    ++inputs.command_count;
  }
}

}  // namespace

void run_cycle(AttitudeInitApp& app, const CycleInterfaces& interfaces, std::int64_t now_ns,
               std::uint32_t cycle_slips, CycleWorkspace& workspace) {
  receive_frames(interfaces.lidar, workspace);
  receive_commands(interfaces.link, workspace.inputs);
  workspace.inputs.cycle_slips = cycle_slips;
  app.step(now_ns, workspace.inputs, workspace.outputs);

  const StepOutputs& outputs = workspace.outputs;
  hal::Link& link = interfaces.link;
  link.publish(outputs.attitude);
  link.publish(outputs.telemetry);
  for (int i = 0; i < outputs.event_count; ++i) link.publish(outputs.events[static_cast<std::size_t>(i)]);
  if (outputs.has_dump) link.publish(outputs.dump);
  if (outputs.duties_done) interfaces.watchdog.kick();
}

}  // namespace tumblesight::fsw
