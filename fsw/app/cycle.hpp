// One cycle of the flight task: receive from the HAL, step the application, publish its outputs. It is the
// same on every platform; a platform's main decides when it runs and with which time.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/attitude_init_app.hpp"
#include "hal/lidar.hpp"
#include "hal/link.hpp"
#include "hal/navigation.hpp"
#include "hal/stopwatch.hpp"
#include "hal/watchdog.hpp"

namespace tumblesight::fsw {

// Memory of run_cycle(), about 80 kB. Allocate it statically, so that no frame is on the stack.
struct CycleWorkspace {
  std::array<gnc::RangeImage, 2> frames;  // the newest usable one so far, and the one that is being received
  std::array<gnc::SignatureStart, 2> starts;      // of the frames
  std::array<gnc::FrameSignature, 2> signatures;  // of the frames, where they are compared in full
  StepInputs inputs;
  StepOutputs outputs;
  std::uint32_t previous_cycle_us = 0;  // 0: not measured
};

// The interfaces of a cycle.
struct CycleInterfaces {
  hal::Lidar& lidar;
  hal::Link& link;
  hal::Watchdog& watchdog;
  hal::Stopwatch& stopwatch;
  hal::Navigation* navigation = nullptr;  // nullptr: the chaser's attitude is not known
  // A late cycle cuts its registration short, so that its report is on time. False for runs whose results
  // must not depend on how fast the machine is.
  bool keeps_deadline = true;
};

// Receives at most kMaxDeliveriesPerCycle deliveries of the LiDAR and kMaxCommandsPerStep commands; the
// others wait for the next cycle. The step gets the newest usable frame. `now_ns`: time of the cycle.
// `cycle_slips`: releases of the task missed since the last cycle. Kicks the watchdog after everything is
// published, if the step reports duties_done. The telemetry of the next cycle says how long all of this took.
void run_cycle(AttitudeInitApp& app, const CycleInterfaces& interfaces, std::int64_t now_ns,
               std::uint32_t cycle_slips, CycleWorkspace& workspace);

}  // namespace tumblesight::fsw
