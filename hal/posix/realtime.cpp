#include "hal/posix/realtime.hpp"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include "hal/posix/monotonic_stopwatch.hpp"

namespace tumblesight::hal::posix {

RealtimeGrant request_realtime(int priority) {
  RealtimeGrant grant;
  sched_param parameters{};
  parameters.sched_priority = priority;
  grant.scheduler_error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  grant.memory_lock_error = mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
  return grant;
}

namespace {

void sleep_until(std::int64_t time_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  if (time_ns < 0) return;
  timespec until{};
  until.tv_sec = static_cast<time_t>(time_ns / kSecond_ns);
  until.tv_nsec = static_cast<long>(time_ns % kSecond_ns);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace

PosixPeriodicTask::PosixPeriodicTask(std::int64_t first_release_ns, std::int64_t period_ns)
    : next_ns_(first_release_ns), period_ns_(period_ns < kMinPeriod_ns ? kMinPeriod_ns : period_ns) {}

std::int64_t PosixPeriodicTask::wait_next_release_ns(std::uint32_t& slips) {
  const auto now_ns = static_cast<std::int64_t>(MonotonicStopwatch().now_ns());
  if (now_ns > next_ns_) {
    const std::int64_t skipped = (now_ns - next_ns_) / period_ns_;
    const auto room = static_cast<std::int64_t>(UINT32_MAX - slips);
    slips += static_cast<std::uint32_t>(skipped < room ? skipped + 1 : room);
    next_ns_ += skipped * period_ns_;
  }
  const std::int64_t release_ns = next_ns_;
  next_ns_ += period_ns_;
  sleep_until(release_ns);
  return release_ns;
}

}  // namespace tumblesight::hal::posix
