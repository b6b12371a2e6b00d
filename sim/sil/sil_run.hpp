// A software-in-the-loop (SIL) run: the simulator is the time master, the flight program is a second process,
// and they communicate over DDS. What the flight program sees is simulated or recorded (StepSource).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/development_key.hpp"
#include "sim/recording/run_step.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

struct SilSettings {
  std::string target = "near_shoemaker";  // that the model image must be for
  std::string model_path;                 // passed to the flight program
  std::uint32_t model_crc32 = 0;          // that the flight program's image must have; 0: any
  std::string flight_path;                // program to start; empty: the user starts it
  int domain = -1;               // DDS domain; -1: a free one, so that concurrent runs do not interfere
  double speed = 0.0;            // times real time; 0: as fast as possible
  bool free_running = false;     // flight on its own timer, 2.7 s divided by speed, not in lockstep
  bool ego_motion = true;        // the flight program is told the chaser's attitude at each exposure
  double step_timeout_s = 60.0;  // wall clock; a step without an answer by then ends the run
  std::string flight_log_path;   // file for the flight program's messages; empty: our own output
  std::string mcap_path;         // file for a recording of the run; empty: none
  double swath_m = 0.0;          // of the truth's displacement from the boresight, for the recording
  std::string security_path;  // file that secures the bus, passed to the flight program; empty: not secured
  std::vector<std::string> flight_arguments;  // additional ones
  // The flight program must have the same key.
  std::array<std::uint8_t, 32> command_key = hal::dds::kDevelopmentKey;
};

// What another program asked of the run while it went on (RunControl).
struct RunRequest {
  std::uint32_t step = 0;  // in which it took effect
  std::string what;        // "NOOP", "debris 1.5 m for 5 steps"
};

struct SilRunResult {
  std::vector<StepResult> steps;
  std::vector<RunRequest> requests;                               // in their order
  std::vector<std::pair<std::size_t, gnc::RangeImage>> pictures;  // index into steps, frame; a selection
  std::uint32_t steps_planned = 0;
  std::uint32_t steps_missed = 0;             // without an answer, and not superseded
  std::uint32_t frames_superseded = 0;        // free-running: a newer frame of the same cycle was used
  std::uint32_t flight_heap_allocations = 0;  // from the last answer
  std::uint32_t flight_frames_dropped = 0;    // from the last answer: superseded, or without room to wait
  std::uint32_t trace_crc32 = 0;              // TraceDigest over all answered steps
  // Empty, or why the run ended early (flight program gone, different interface hash, ...).
  std::string failure;
};

class StepSource;

// Runs the steps of `source` in order. `progress(done, planned)` is called after every step, `frame_sent`
// with every frame, in order. Does not throw: a run that ends early returns the steps up to then, with
// `failure` set. A free-running flight program needs frames whose sequence number is the index of their step.
using SilProgress = std::function<void(std::uint32_t done, std::uint32_t planned)>;
using FrameObserver = std::function<void(const StepResult& step, const gnc::RangeImage& frame)>;
SilRunResult run_sil(const SilSettings& settings, StepSource& source, const SilProgress& progress,
                     const FrameObserver& frame_sent = {});

// The same with simulated sequences (SimulatedSteps).
SilRunResult run_sil(const SilSettings& settings, const FlashLidar& lidar, double swath_m,
                     const std::vector<Sequence>& sequences, const SilProgress& progress,
                     const FrameObserver& frame_sent = {});

}  // namespace tumblesight::sim
