// PosixPeriodicTask: releases at absolute times of CLOCK_MONOTONIC, first_release + k * period, so that the
// length of one cycle never shifts the next.
#pragma once

#include "hal/task.hpp"

namespace tumblesight::hal::posix {

class PosixPeriodicTask final : public PeriodicTask {
 public:
  static constexpr std::int64_t kMinPeriod_ns = 100'000;

  // Times of CLOCK_MONOTONIC. A shorter period than kMinPeriod_ns is taken as that.
  PosixPeriodicTask(std::int64_t first_release_ns, std::int64_t period_ns);

  // Every release that passed while the task was still busy is added to `slips` (which saturates); the last
  // of them is served at once, late, those before it are skipped. Signals do not shorten the wait.
  std::int64_t wait_next_release_ns(std::uint32_t& slips) override;

 private:
  std::int64_t next_ns_;
  std::int64_t period_ns_;
};

}  // namespace tumblesight::hal::posix
