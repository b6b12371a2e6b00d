// One cycle of the flight task: gather what the HAL has, step the application, publish what it gives. The
// same on every platform; a platform's main decides when it runs and what time it is.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/attitude_init_app.hpp"
#include "hal/lidar.hpp"
#include "hal/link.hpp"

namespace tumblesight::fsw {

// Memory of run_cycle(), about 70 kB: static, so that no frame lies on the stack.
struct CycleWorkspace {
  std::array<gnc::RangeImage, config::kMaxFramesPerStep> frames;
  StepInputs inputs;
  StepOutputs outputs;
};

struct CyclePublished {
  int attitudes = 0;
  int telemetries = 0;
  int events = 0;
};

// Takes at most kMaxFramesPerStep deliveries of the lidar and kMaxCommandsPerStep commands; what is left
// waits for the next cycle.
CyclePublished run_cycle(App& app, hal::Lidar& lidar, hal::Link& link, std::int64_t now_ns,
                         CycleWorkspace& workspace);

}  // namespace tumblesight::fsw
