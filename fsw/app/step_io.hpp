// Inputs and outputs of one step of the flight application.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/config/limits.hpp"
#include "gnc/attitude/chaser_attitude.hpp"
#include "gnc/estimation/frame_gate.hpp"
#include "gnc/lidar/depth_image.hpp"
#include "gnc/lidar/range_image.hpp"
#include "hal/link.hpp"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/memory_dump.hpp"
#include "hal/messages/telemetry.hpp"
#include "hal/stopwatch.hpp"

namespace tumblesight::fsw {

using hal::Validity;

// A frame that arrived and does not reach the estimator.
struct DroppedFrame {
  gnc::FrameVerdict why = gnc::FrameVerdict::kSuperseded;
  std::uint32_t sequence_number = 0;
  std::int64_t exposure_time_ns = 0;
  gnc::FrameStatus content = gnc::FrameStatus::kOk;  // if its content is bad
  std::uint16_t rays = 0;
};

// Of the cycle that the step is part of.
struct CycleTiming {
  // By which a late cycle cuts its registration short (cycle_deadline.hpp); nullptr: it does not.
  hal::Stopwatch* stopwatch = nullptr;
  std::uint64_t start_ns = 0;     // by the stopwatch
  std::uint32_t previous_us = 0;  // that the previous cycle took; 0: not measured
};

// Counts outside their range are a bug of the caller: the step raises an assertion and goes SAFE.
struct StepInputs {
  const gnc::RangeImage* frame = nullptr;  // the newest usable one; nullptr: no frame in this cycle
  gnc::ChaserAttitude chaser;              // at the exposure of `frame`
  gnc::ChaserAttitude chaser_now;          // at the cycle time
  // The other frames of this cycle, as AttitudeInitApp::judge() or the choice between them decided.
  std::array<DroppedFrame, config::kMaxDeliveriesPerCycle> dropped{};
  int dropped_count = 0;
  int frame_wrong_size = 0;  // deliveries that the sensor interface dropped; with dropped_count and `frame`
                             // at most kMaxDeliveriesPerCycle
  std::uint32_t frames_overflowed =
      0;  // dropped by the sensor interface for lack of room, since the last step
  std::array<hal::CommandPacket, config::kMaxCommandsPerStep> commands{};
  int command_count = 0;
  hal::DroppedCommands commands_dropped;  // by the link, since the last step
  std::uint32_t cycle_slips = 0;          // releases of the task missed since the last step
  CycleTiming timing;

  int deliveries() const { return (frame != nullptr ? 1 : 0) + dropped_count + frame_wrong_size; }
};

struct StepOutputs {
  hal::AttitudeReport attitude;  // of the frame used in this cycle
  hal::Telemetry telemetry;
  std::array<hal::Event, config::kMaxEventsPerStep> events{};
  int event_count = 0;
  hal::MemoryDump dump;
  bool has_dump = false;
  bool duties_done = false;  // the watchdog may be kicked
};

}  // namespace tumblesight::fsw
