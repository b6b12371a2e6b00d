// A port to a new board in one file: the flight application in a super-loop with every HAL interface
// implemented. It compiles and links everywhere; the functions of namespace `board` stand for your drivers.
// docs/porting.md explains each step. Under an executive, the loop is the body of a task and
// wait_next_release_ns() ends in the executive's wait for a period.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/app/cycle.hpp"
#include "hal/task.hpp"

extern "C" const std::uint8_t model_image[], model_image_end[];  // model_image.S

namespace {

using namespace tumblesight;

namespace board {
// Replace these with your drivers.
std::uint64_t timer_ns() {  // monotonic
  static std::uint64_t ticks = 0;
  return ++ticks * 1000;
}
std::int64_t mission_time_ns() {
  return static_cast<std::int64_t>(timer_ns());
}
const std::uint16_t* take_sensor_frame() {
  return nullptr;
}  // ranges in Q9.7 metres; nullptr: no new frame
std::size_t take_command(std::uint8_t*, std::size_t) {
  return 0;
}  // bytes of the packet; 0: none
void send(const void*, std::size_t) {}
void kick_watchdog() {}
}  // namespace board

constexpr std::uint16_t kSensorRays = 128;
constexpr std::uint32_t kSensorFov_urad = 349'066;  // 20 degrees

class SensorLidar final : public hal::Lidar {
 public:
  hal::LidarStatus receive(gnc::RangeImage& frame) override {
    const std::uint16_t* const ranges = board::take_sensor_frame();
    if (ranges == nullptr) return hal::LidarStatus::kNoFrame;
    frame.exposure_time_ns = board::mission_time_ns();
    frame.sequence_number = ++sequence_number_;
    frame.fov_urad = kSensorFov_urad;
    frame.rays = kSensorRays;
    std::copy_n(ranges, kSensorRays * kSensorRays, frame.ranges.begin());
    return hal::LidarStatus::kFrame;
  }

 private:
  std::uint32_t sequence_number_ = 0;
};

// A real link packs the fields of each message into a telemetry packet.
class RadioLink final : public hal::Link {
 public:
  bool receive(hal::CommandPacket& command) override {
    command.size =
        static_cast<std::uint16_t>(board::take_command(command.bytes.data(), command.bytes.size()));
    return command.size > 0;
  }
  void publish(const hal::AttitudeReport& report) override { board::send(&report, sizeof report); }
  void publish(const hal::Telemetry& telemetry) override { board::send(&telemetry, sizeof telemetry); }
  void publish(const hal::Event& event) override { board::send(&event, sizeof event); }
  void publish(const hal::MemoryDump& dump) override { board::send(&dump, sizeof dump); }
};

// One bank in read-only memory. With a second, writable bank a damaged model can be repaired or replaced in
// flight.
class RomModelStore final : public hal::ModelStore {
 public:
  hal::ModelBank bank(int index) override {
    const auto size = static_cast<std::size_t>(model_image_end - model_image);
    return index == 0 ? hal::ModelBank{model_image, hal::BankWriting::kReadOnly, size, size}
                      : hal::ModelBank{};
  }
};

class TimerStopwatch final : public hal::Stopwatch {
 public:
  std::uint64_t now_ns() override { return board::timer_ns(); }
};

class BoardWatchdog final : public hal::Watchdog {
 public:
  void kick() override { board::kick_watchdog(); }
};

// Releases at absolute times, so that the length of a cycle does not shift the next one.
class FrameTimer final : public hal::PeriodicTask {
 public:
  std::int64_t wait_next_release_ns(std::uint32_t& slips) override {
    for (next_ns_ += kPeriod_ns; board::mission_time_ns() > next_ns_ + kPeriod_ns; next_ns_ += kPeriod_ns)
      ++slips;
    while (board::mission_time_ns() < next_ns_) {
    }
    return next_ns_;
  }

 private:
  static constexpr std::int64_t kPeriod_ns = fsw::config::kFramePeriod_ns;
  std::int64_t next_ns_ = 0;
};

// All memory is static: the application, its working memory and the drivers.
TimerStopwatch stopwatch;
RomModelStore model_store;
SensorLidar lidar;
RadioLink link;
BoardWatchdog watchdog;
FrameTimer timer;
fsw::AttitudeInitApp app;
fsw::CycleWorkspace workspace;

}  // namespace

int main() {
  // No command key: this link delivers authentic telecommands only. "near_shoemaker": refuse the model of
  // another target. Without a usable model the application is in mode SAFE and still reports telemetry.
  // This board has no persistent store, and says that it was powered on after every reset: the application
  // starts in RUN. After a cause that is abnormal or unknown it would start in STANDBY.
  app.init({&stopwatch, &model_store, nullptr, nullptr, hal::ResetCause::kPowerOn}, "near_shoemaker");
  for (;;) {
    std::uint32_t slips = 0;
    const std::int64_t now_ns = timer.wait_next_release_ns(slips);
    fsw::run_cycle(app, {lidar, link, watchdog, stopwatch}, now_ns, slips, workspace);
  }
}
