// FlightTask: the thread that runs the flight application, under the heap trap from its first cycle to its
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
#include "hal/posix/painted_stack.hpp"
#include "hal/task.hpp"

namespace tumblesight::hal::dds {

// Free-running: mission time advances one frame period a timer period, from `mission_time_ns` at `wall_ns`
// on.
struct MissionClock {
  std::int64_t mission_time_ns = 0;
  std::int64_t wall_ns = 0;  // of the timer's clock
  std::int64_t period_ns = 1;

  std::int64_t at(std::int64_t release_ns) const;
};

class FlightTask {
 public:
  FlightTask(DdsLidar& lidar, DdsLink& link, fsw::CycleWorkspace& workspace, posix::PaintedStack& stack);

  // Starts the thread and returns once it is ready; false if the system gives none. Free-running it asks for
  // a fixed priority and locked memory, which takes longer than a cycle may wait: so start it before the run.
  [[nodiscard]] bool start(fsw::AttitudeInitApp& app, bool free_running);
  void join_run(std::uint32_t run_id) { run_id_ = run_id; }
  // Free-running: cycles on the timer from now on.
  void begin_free(PeriodicTask& timer, const MissionClock& clock);

  // Lockstep: one cycle; returns once it is over.
  void run_cycle(std::uint32_t k, std::int64_t now_ns);
  // The thread ends; free-running after one more cycle, if they have begun. Nothing to do without a thread.
  void join();

  // Of the thread, once it has ended.
  std::uint32_t heap_allocations() const { return heap_allocations_; }
  std::size_t first_heap_allocation_bytes() const { return first_heap_allocation_bytes_; }
  std::uint32_t slips() const { return slips_; }

 private:
  static void* thread_main(void* self);
  void run();
  void run_lockstep();
  void run_free();
  void cycle(std::uint32_t k, std::int64_t now_ns, std::uint32_t slips);

  // A desktop has none that could reset it.
  class NoWatchdog final : public Watchdog {
   public:
    void kick() override {}
  };

  fsw::AttitudeInitApp* app_ = nullptr;
  NoWatchdog watchdog_;
  DdsLidar& lidar_;
  DdsLink& link_;
  fsw::CycleWorkspace& workspace_;
  posix::PaintedStack& stack_;
  // Handed over by go_ before the first cycle.
  PeriodicTask* timer_ = nullptr;
  MissionClock clock_;
  std::uint32_t run_id_ = 0;

  pthread_t thread_{};
  bool started_ = false;
  bool free_running_ = false;
  sem_t go_;
  sem_t done_;
  std::atomic<bool> end_requested_{false};
  std::uint32_t k_ = 0;      // lockstep: of the cycle to run, handed over by go_
  std::int64_t now_ns_ = 0;  // likewise

  std::uint32_t heap_allocations_ = 0;
  std::size_t first_heap_allocation_bytes_ = 0;
  std::uint32_t slips_ = 0;
};

}  // namespace tumblesight::hal::dds
