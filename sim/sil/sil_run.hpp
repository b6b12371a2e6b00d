// A software-in-the-loop run: the simulator as time master, the flight program as a second process, DDS
// between them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/development_key.hpp"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/event.hpp"
#include "hal/messages/telemetry.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

struct SilSettings {
  std::string target = "near_shoemaker";  // name that the model image must carry
  std::string model_path;                 // handed to flight
  std::string flight_path;                // program to start; empty: one is expected to be running already
  int domain = -1;               // DDS domain; -1: a free one, so that runs beside each other do not meet
  double speed = 0.0;            // 0: as fast as the machine goes; 1: real time; N: N times real time
  bool free_running = false;     // flight on its own 2.7 s timer (divided by speed) instead of in lockstep
  double step_timeout_s = 10.0;  // wall clock; a step not answered by then ends the run
  std::string flight_log_path;   // file for flight's messages; empty: they come out with our own
  std::vector<std::string> flight_arguments;                             // further arguments for flight
  std::array<std::uint8_t, 32> command_key = hal::dds::kDevelopmentKey;  // the same as flight's
};

// Everything recorded of one step. `frame` is what was sent (for pictures), kept only for the first
// sequences.
struct StepRecord {
  std::uint32_t sequence = 0;
  std::uint32_t frame_index = 0;
  std::int64_t time_ns = 0;
  FrameTruth truth;
  bool answered = false;
  hal::AttitudeReport attitude;
  hal::Telemetry telemetry;
  std::vector<hal::Event> events;
  std::uint32_t state_crc32 = 0;
};

// Valid or doubtful.
bool gives_attitude(const hal::AttitudeReport& report);

struct SilRecording {
  std::vector<StepRecord> steps;
  std::vector<std::pair<std::size_t, gnc::RangeImage>> pictures;  // (index into steps, frame)
  std::uint32_t steps_planned = 0;
  std::uint32_t steps_missed = 0;             // planned but never answered
  std::uint32_t flight_heap_allocations = 0;  // from the last telemetry
  std::uint32_t trace_crc32 = 0;              // over every answered step's bits, wall-clock times left out
  std::string failure;  // empty, or why the run ended early (flight gone, ICD unequal, ...)
};

// Runs `sequences` one after the other, with a reset command before each. Never throws for what the flight
// side does: whatever was recorded until then is returned with `failure` set. `progress(done, planned)` after
// every step; `frame_sent` with each frame, in their order.
using SilProgress = std::function<void(std::uint32_t done, std::uint32_t planned)>;
using FrameObserver = std::function<void(const StepRecord& step, const gnc::RangeImage& frame)>;
SilRecording run_sil(const SilSettings& settings, const FlashLidar& lidar, double swath_m,
                     const std::vector<Sequence>& sequences, const SilProgress& progress,
                     const FrameObserver& frame_sent = {});

}  // namespace tumblesight::sim
