// Inputs and outputs of one step of the flight application.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/config/limits.hpp"
#include "gnc/lidar/range_image.hpp"
#include "hal/link.hpp"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/model_dump.hpp"
#include "hal/messages/telemetry.hpp"

namespace tumblesight::fsw {

using hal::Validity;

// Counts outside their range are a bug of the caller: the step raises an assertion and goes SAFE.
struct StepInputs {
  const gnc::RangeImage* frame = nullptr;  // nullptr: no frame in this cycle
  int frame_count = 1;                     // frames at `frame`, oldest first: 0 ... kMaxFramesPerStep
  int frame_wrong_size = 0;                // deliveries that the sensor interface dropped; with frame_count
                                           // at most kMaxFramesPerStep
  std::array<hal::CommandPacket, config::kMaxCommandsPerStep> commands{};
  int command_count = 0;
  hal::DroppedCommands commands_dropped;  // by the link, since the last step
  std::uint32_t cycle_slips = 0;          // releases of the task missed since the last step

  int frames() const { return frame != nullptr ? frame_count : 0; }
};

struct StepOutputs {
  hal::AttitudeReport attitude;  // of the last frame accepted in this cycle
  hal::Telemetry telemetry;
  std::array<hal::Event, config::kMaxEventsPerStep> events{};
  int event_count = 0;
  hal::ModelDump dump;
  bool has_dump = false;
  bool duties_done = false;  // the watchdog may be kicked
};

}  // namespace tumblesight::fsw
