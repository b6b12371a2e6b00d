// Real-time settings and the periodic task.
#pragma once

#include "hal/task.hpp"

namespace tumblesight::hal::posix {

// Requests a fixed priority and memory that is never paged out from Linux.
// 0: granted; otherwise the errno (EPERM without the privilege). The task also runs without the grants, with
// more jitter, so the values are for the start-up message only.
struct RealtimeGrant {
  int scheduler_error = 0;    // SCHED_FIFO for the calling thread
  int memory_lock_error = 0;  // all current and future pages
};

// `priority`: 1 (lowest) to 99.
[[nodiscard]] RealtimeGrant request_realtime(int priority);

// PosixPeriodicTask: releases at the absolute times first_release + k * period of CLOCK_MONOTONIC, so that
// the length of one cycle does not shift the next.
class PosixPeriodicTask final : public PeriodicTask {
 public:
  static constexpr std::int64_t kMinPeriod_ns = 100'000;

  // Times of CLOCK_MONOTONIC. Periods below kMinPeriod_ns are raised to it.
  PosixPeriodicTask(std::int64_t first_release_ns, std::int64_t period_ns);

  // Adds the releases that passed while the task was busy to `slips`, which saturates. The latest of them is
  // served at once, late; the earlier ones are skipped. Signals do not shorten the wait.
  std::int64_t wait_next_release_ns(std::uint32_t& slips) override;

 private:
  std::int64_t next_ns_;
  std::int64_t period_ns_;
};

}  // namespace tumblesight::hal::posix
