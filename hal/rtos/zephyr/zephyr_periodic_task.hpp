// ZephyrPeriodicTask: releases by a kernel timer of Zephyr. One thread at a time may wait.
#pragma once

#include <zephyr/kernel.h>

#include "hal/rtos/missed_releases.hpp"
#include "hal/rtos/zephyr/zephyr_stopwatch.hpp"
#include "hal/task.hpp"

namespace tumblesight::hal::rtos {

class ZephyrPeriodicTask final : public PeriodicTask {
 public:
  ZephyrPeriodicTask() { k_timer_init(&timer_, nullptr, nullptr); }
  ~ZephyrPeriodicTask() { stop(); }
  ZephyrPeriodicTask(const ZephyrPeriodicTask&) = delete;  // the kernel keeps its address
  ZephyrPeriodicTask& operator=(const ZephyrPeriodicTask&) = delete;

  // The first release is one period from now. False: the period is not positive. It is rounded up to whole
  // ticks.
  [[nodiscard]] bool start(std::int64_t period_ns) {
    if (period_ns <= 0) return false;
    k_timer_start(&timer_, K_NSEC(period_ns), K_NSEC(period_ns));
    is_running_ = true;
    return true;
  }
  // False: it was stopped, and every further wait returns at once.
  bool is_running() const { return is_running_; }
  void stop() {
    k_timer_stop(&timer_);
    is_running_ = false;
  }

  // Serves the latest of the releases that passed while the thread was busy at once; the earlier ones are
  // skipped. Returns the clock's time, which is late by the thread's own delay.
  std::int64_t wait_next_release_ns(std::uint32_t& slips) override {
    const std::uint32_t missed = k_timer_status_get(&timer_);
    if (missed == 0) is_running_ = k_timer_status_sync(&timer_) > 0;
    add_missed(missed, slips);
    return static_cast<std::int64_t>(ZephyrStopwatch().now_ns());
  }

 private:
  struct k_timer timer_ {};
  bool is_running_ = false;
};

}  // namespace tumblesight::hal::rtos
