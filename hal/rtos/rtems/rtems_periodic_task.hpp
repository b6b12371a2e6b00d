// RtemsPeriodicTask: releases by a rate-monotonic period of RTEMS 6. The task that starts it owns it: no
// other task can wait.
#pragma once

#include <rtems.h>

#include "hal/rtos/missed_releases.hpp"
#include "hal/rtos/rtems/rtems_stopwatch.hpp"
#include "hal/task.hpp"

namespace tumblesight::hal::rtos {

class RtemsPeriodicTask final : public PeriodicTask {
 public:
  RtemsPeriodicTask() = default;
  ~RtemsPeriodicTask() { stop(); }
  RtemsPeriodicTask(const RtemsPeriodicTask&) = delete;
  RtemsPeriodicTask& operator=(const RtemsPeriodicTask&) = delete;

  // The first release is one period from now. False: the period is not a multiple of a clock tick, or RTEMS
  // has no period left (CONFIGURE_MAXIMUM_PERIODS).
  [[nodiscard]] bool start(std::int64_t period_ns) {
    stop();
    const std::int64_t tick_ns = std::int64_t{rtems_configuration_get_microseconds_per_tick()} * 1000;
    if (period_ns <= 0 || period_ns % tick_ns != 0 || period_ns / tick_ns > UINT32_MAX) return false;
    period_ticks_ = static_cast<rtems_interval>(period_ns / tick_ns);
    if (rtems_rate_monotonic_create(rtems_build_name('T', 'S', 'G', 'T'), &id_) != RTEMS_SUCCESSFUL)
      return false;
    is_running_ = rtems_rate_monotonic_period(id_, period_ticks_) == RTEMS_SUCCESSFUL;
    return is_running_;
  }
  // False: RTEMS refused to wait, and every further wait returns at once.
  bool is_running() const { return is_running_; }
  void stop() {
    if (id_ != 0) static_cast<void>(rtems_rate_monotonic_delete(id_));  // cancels it, too
    id_ = 0;
    is_running_ = false;
  }

  // Serves the latest of the releases that passed while the task was busy at once; the earlier ones are
  // skipped. Returns the clock's time, not a sum of periods: boards round the length of a tick, and the sum
  // would drift away from the clock that stamps the frames.
  std::int64_t wait_next_release_ns(std::uint32_t& slips) override {
    std::uint32_t missed = 0;
    rtems_status_code status = RTEMS_SUCCESSFUL;
    do {
      status = rtems_rate_monotonic_period(id_, period_ticks_);
      if (status == RTEMS_TIMEOUT) ++missed;
    } while (status == RTEMS_TIMEOUT && postponed_jobs() > 0 && missed < kMostSkipped);
    is_running_ = status == RTEMS_SUCCESSFUL || status == RTEMS_TIMEOUT;
    add_missed(missed, slips);
    return static_cast<std::int64_t>(RtemsStopwatch().now_ns());
  }

 private:
  // More of them are skipped by the next calls.
  static constexpr std::uint32_t kMostSkipped = 1000;

  std::uint32_t postponed_jobs() const {
    rtems_rate_monotonic_period_status now{};
    return rtems_rate_monotonic_get_status(id_, &now) == RTEMS_SUCCESSFUL ? now.postponed_jobs_count : 0;
  }

  rtems_id id_ = 0;  // never that of an object
  rtems_interval period_ticks_ = 0;
  bool is_running_ = false;
};

}  // namespace tumblesight::hal::rtos
