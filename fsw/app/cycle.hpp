// One cycle of the flight task: gather what the HAL has, step the application, publish what it gives. The
// same on every platform; a platform's main decides when it runs and what time it is.
#pragma once

#include <array>
#include <cstdint>

#include "fsw/app/attitude_init_app.hpp"
#include "hal/lidar.hpp"
#include "hal/link.hpp"
#include "hal/watchdog.hpp"

namespace tumblesight::fsw {

// Memory of run_cycle(), about 80 kB: static, so that no frame lies on the stack.
struct CycleWorkspace {
  std::array<gnc::RangeImage, config::kMaxFramesPerStep> frames;
  StepInputs inputs;
  StepOutputs outputs;
};

// What a cycle works with.
struct CycleInterfaces {
  hal::Lidar& lidar;
  hal::Link& link;
  hal::Watchdog& watchdog;
};

// The application in either numerics.
class App {
 public:
  virtual void step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs) = 0;
  virtual std::uint32_t state_crc32() const = 0;
  virtual Mode mode() const = 0;

 protected:
  ~App() = default;
};

// Lies beside the application, so that no bit flip in the application's memory can misdirect a call.
template <class N>
class AppOf final : public App {
 public:
  explicit AppOf(AttitudeInitApp<N>& app) : app_(app) {}
  void step(std::int64_t now_ns, const StepInputs& inputs, StepOutputs& outputs) override {
    app_.step(now_ns, inputs, outputs);
  }
  std::uint32_t state_crc32() const override { return app_.state_crc32(); }
  Mode mode() const override { return app_.mode(); }

 private:
  AttitudeInitApp<N>& app_;
};

// Takes at most kMaxFramesPerStep deliveries of the lidar and kMaxCommandsPerStep commands; what is left
// waits for the next cycle. `cycle_slips`: releases of the task missed since the last cycle. The watchdog is
// kicked once all has been done and published.
void run_cycle(App& app, const CycleInterfaces& interfaces, std::int64_t now_ns, std::uint32_t cycle_slips,
               CycleWorkspace& workspace);

}  // namespace tumblesight::fsw
