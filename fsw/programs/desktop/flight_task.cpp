#include "fsw/programs/desktop/flight_task.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "fsw/config/limits.hpp"
#include "fsw/programs/desktop/flight_program.hpp"
#include "fsw/programs/desktop/heap_trap.hpp"
#include "hal/posix/realtime.hpp"

namespace tumblesight::fsw::desktop {
namespace {

static_assert(hal::dds::kMaxEventsPerStep >= fsw::config::kMaxEventsPerStep);

void wait(sem_t& semaphore) {
  while (sem_wait(&semaphore) != 0 && errno == EINTR) {
  }
}

const char* granted(int error) {
  return error == 0 ? "granted" : strerrordesc_np(error);
}

// The task also runs without these grants, with more jitter.
void become_realtime() {
  // Above all tasks without a real-time priority, below tasks that were given a high one on purpose.
  constexpr int kPriority = 10;
  const hal::posix::RealtimeGrant grant = hal::posix::request_realtime(kPriority);
  std::fprintf(stderr, "%s: fixed priority %d: %s; ", kProgramName, kPriority,
               granted(grant.scheduler_error));
  std::fprintf(stderr, "memory locked: %s\n", granted(grant.memory_lock_error));
}

}  // namespace

std::int64_t MissionClock::at(std::int64_t release_ns) const {
  const double periods = static_cast<double>(release_ns - wall_ns) / static_cast<double>(period_ns);
  return mission_time_ns +
         static_cast<std::int64_t>(periods * static_cast<double>(fsw::config::kFramePeriod_ns));
}

FlightTask::FlightTask(hal::dds::DdsLidar& lidar, hal::dds::DdsNavigation& navigation,
                       hal::dds::DdsLink& link, hal::Stopwatch& stopwatch, CycleWorkspace& workspace,
                       hal::posix::MonitoredStack& stack)
    : lidar_(lidar),
      navigation_(navigation),
      link_(link),
      stopwatch_(stopwatch),
      workspace_(workspace),
      stack_(stack) {
  sem_init(&go_, 0, 0);
  sem_init(&done_, 0, 0);
}

bool FlightTask::start(AttitudeInitApp& app, bool free_running) {
  app_ = &app;
  free_running_ = free_running;
  started_ = stack_.start(thread_, thread_main, this);
  if (started_) wait(done_);
  return started_;
}

void FlightTask::start_cycles(hal::PeriodicTask& timer, const MissionClock& clock) {
  timer_ = &timer;
  clock_ = clock;
  sem_post(&go_);
}

void FlightTask::request_cycle(std::uint32_t k, std::int64_t now_ns) {
  k_ = k;
  now_ns_ = now_ns;
  sem_post(&go_);
  wait(done_);
}

void FlightTask::join() {
  if (!started_) return;
  started_ = false;
  end_requested_ = true;
  sem_post(&go_);
  pthread_join(thread_, nullptr);
}

void* FlightTask::thread_main(void* self) {
  static_cast<FlightTask*>(self)->run();
  return nullptr;
}

void FlightTask::run() {
  if (free_running_) become_realtime();
  sem_post(&done_);
  arm_heap_trap();
  free_running_ ? run_on_timer() : run_on_request();
  disarm_heap_trap();
  heap_allocations_ = desktop::heap_allocations();
  first_heap_allocation_bytes_ = desktop::first_heap_allocation_bytes();
}

void FlightTask::run_on_request() {
  for (;;) {
    wait(go_);
    if (end_requested_) return;
    cycle(k_, now_ns_, 0);
    sem_post(&done_);
  }
}

void FlightTask::run_on_timer() {
  wait(go_);
  if (timer_ == nullptr) return;  // join() came before start_cycles()
  bool last = false;
  for (std::uint32_t k = 0; !last; ++k) {
    const std::uint32_t slips_before = slips_;
    const std::int64_t release_ns = timer_->wait_next_release_ns(slips_);
    last = end_requested_;
    cycle(k, clock_.at(release_ns), slips_ - slips_before);
  }
}

void FlightTask::cycle(std::uint32_t k, std::int64_t now_ns, std::uint32_t slips) {
  link_.begin_cycle(run_id_, k);
  fsw::run_cycle(*app_, {lidar_, link_, watchdog_, stopwatch_, &navigation_, free_running_}, now_ns, slips,
                 workspace_);
  link_.end_cycle(app_->state_crc32());
}

}  // namespace tumblesight::fsw::desktop
