// FlightTask: the thread that runs the flight application. The heap trap is armed from its first cycle to its
// last.
#pragma once

#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/app/cycle.hpp"
#include "hal/dds/dds_lidar.hpp"
#include "hal/dds/dds_link.hpp"
#include "hal/dds/dds_navigation.hpp"
#include "hal/posix/monitored_stack.hpp"
#include "hal/stopwatch.hpp"
#include "hal/task.hpp"

namespace tumblesight::fsw::desktop {

// Free-running: mission time starts with `mission_time_ns` at wall-clock time `wall_ns` and advances one
// frame period per timer period.
struct MissionClock {
  std::int64_t mission_time_ns = 0;
  std::int64_t wall_ns = 0;  // on the timer's clock
  std::int64_t period_ns = 1;

  // Mission time at a release of the timer.
  std::int64_t at(std::int64_t release_ns) const;
};

class FlightTask {
 public:
  FlightTask(hal::dds::DdsLidar& lidar, hal::dds::DdsNavigation& navigation, hal::dds::DdsLink& link,
             hal::Stopwatch& stopwatch, CycleWorkspace& workspace, hal::posix::MonitoredStack& stack);

  // Starts the thread and returns when it is ready; false if the system provides no thread. A free-running
  // task requests a fixed priority and locked memory, which takes longer than a cycle: start it before the
  // run. Only a free-running task keeps the deadline of its cycles: a run in lockstep gives the same results
  // on any machine.
  [[nodiscard]] bool start(AttitudeInitApp& app, bool free_running);
  // Call it before the first cycle: telemetry carries the run id.
  void set_run_id(std::uint32_t run_id) { run_id_ = run_id; }
  // Free-running: cycles start with the timer's next release.
  void start_cycles(hal::PeriodicTask& timer, const MissionClock& clock);

  // Lockstep: runs one cycle and returns when it has ended.
  void request_cycle(std::uint32_t k, std::int64_t now_ns);
  // Ends the thread; a free-running task that has started its cycles runs one more. No effect without a
  // thread.
  void join();

  // Of the thread, valid after join().
  std::uint32_t heap_allocations() const { return heap_allocations_; }
  std::size_t first_heap_allocation_bytes() const { return first_heap_allocation_bytes_; }
  std::uint32_t slips() const { return slips_; }

 private:
  static void* thread_main(void* self);
  void run();
  void run_on_request();
  void run_on_timer();
  void cycle(std::uint32_t k, std::int64_t now_ns, std::uint32_t slips);

  // A desktop has no watchdog.
  class NoWatchdog final : public hal::Watchdog {
   public:
    void kick() override {}
  };

  AttitudeInitApp* app_ = nullptr;
  NoWatchdog watchdog_;
  hal::dds::DdsLidar& lidar_;
  hal::dds::DdsNavigation& navigation_;
  hal::dds::DdsLink& link_;
  hal::Stopwatch& stopwatch_;
  CycleWorkspace& workspace_;
  hal::posix::MonitoredStack& stack_;
  // Written before go_ is posted for the first cycle.
  hal::PeriodicTask* timer_ = nullptr;
  MissionClock clock_;
  std::uint32_t run_id_ = 0;

  pthread_t thread_{};
  bool started_ = false;
  bool free_running_ = false;
  sem_t go_;
  sem_t done_;
  std::atomic<bool> end_requested_{false};
  std::uint32_t k_ = 0;      // lockstep: of the requested cycle, written before go_ is posted
  std::int64_t now_ns_ = 0;  // same

  std::uint32_t heap_allocations_ = 0;
  std::size_t first_heap_allocation_bytes_ = 0;
  std::uint32_t slips_ = 0;
};

}  // namespace tumblesight::fsw::desktop
