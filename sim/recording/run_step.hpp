// One step of a run, whoever runs or records it: what the simulator sends, and the answer of the flight
// program.
#pragma once

#include <cstdint>
#include <vector>

#include "gnc/attitude/chaser_attitude.hpp"
#include "gnc/lidar/range_image.hpp"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/telemetry.hpp"
#include "sim/operations/signed_telecommand.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

// What the simulator sends for one step. Each frame has its own exposure time and sequence number.
struct StepInput {
  std::int64_t time_ns = 0;
  std::vector<const gnc::RangeImage*> frames;
  std::vector<gnc::ChaserAttitude> navigations;  // of the chaser, at the exposures of the frames
  std::vector<Telecommand> commands;
  std::vector<hal::CommandPacket> packets;  // sent after `commands`, unchanged: for tests of invalid packets
  bool last = false;
};

// One step: what was sent, and the answer of the flight program.
struct StepResult {
  std::uint32_t sequence = 0;
  std::uint32_t frame_index = 0;
  std::int64_t time_ns = 0;
  std::int64_t exposure_time_ns = 0;  // of the frame that the sensor took; without one that of the step
  FrameTruth truth;                   // of the frame that the attitude is from, if that is an earlier one
  bool truth_known = true;            // otherwise the truth says only whether a frame was delivered
  bool answered = false;
  hal::AttitudeReport attitude;
  hal::Telemetry telemetry;
  std::vector<hal::Event> events;
  std::uint32_t state_crc32 = 0;
};

// Whether the report holds an attitude: valid or doubtful.
inline bool gives_attitude(const hal::AttitudeReport& report) {
  return report.validity == hal::Validity::kValid || report.validity == hal::Validity::kDoubtful;
}

}  // namespace tumblesight::sim
