// Flight: the flight program of a real-time operating system. One task calls start() and run(); the tasks of
// sensor and radio use lidar() and link() between the two and from then on.
#pragma once

#include "fsw/app/cycle.hpp"
#include "fsw/programs/rtos/board.hpp"
#include "hal/rtos/queue_lidar.hpp"
#include "hal/rtos/queue_link.hpp"

namespace tumblesight::fsw::rtos {

// Task, Clock and Queue: those of the system, in hal/rtos.
template <class Task, class Clock, template <class, std::size_t> class Queue>
class Flight {
 public:
  using Lidar = hal::rtos::QueueLidar<Queue>;
  using Link = hal::rtos::QueueLink<Queue>;
  static_assert(Link::kMaxPackets >= 2 * (config::kMaxEventsPerStep + 3), "room for two cycles");
  static_assert(Link::kMaxCommands >= 2 * config::kMaxCommandsPerStep, "room for two cycles");

  // Boots the application. False: the system has too few message queues.
  [[nodiscard]] bool start(const Board& board) {
    if (!lidar_.open() || !link_.open()) return false;
    hal::Platform platform = board.platform;
    platform.stopwatch = &clock_;
    app_.init(platform, board.target);
    if (platform.command_keys != nullptr)
      link_.authenticate_with(*platform.command_keys, app_.key_slot(), app_.command_counter());
    return true;
  }
  // One cycle per period. Returns when the system refuses its timer.
  void run(const Board& board) {
    if (!task_.start(config::kFramePeriod_ns)) return;
    for (;;) {
      std::uint32_t slips = 0;
      const std::int64_t now_ns = task_.wait_next_release_ns(slips);
      if (!task_.is_running()) return;
      run_cycle(app_, {lidar_, link_, *board.watchdog, board.navigation}, now_ns, slips, workspace_);
    }
  }

  // Stamps frames with this clock's time: the application compares it with that of its cycles.
  Clock& clock() { return clock_; }
  Lidar& lidar() { return lidar_; }
  Link& link() { return link_; }
  const AttitudeInitApp& app() const { return app_; }

 private:
  Clock clock_;
  Task task_;
  Lidar lidar_;
  Link link_;
  AttitudeInitApp app_;
  CycleWorkspace workspace_;
};

}  // namespace tumblesight::fsw::rtos
