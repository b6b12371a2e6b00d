// MonotonicStopwatch: CLOCK_MONOTONIC, the clock of PosixPeriodicTask.
#pragma once

#include "hal/stopwatch.hpp"

namespace tumblesight::hal::posix {

class MonotonicStopwatch final : public Stopwatch {
 public:
  std::uint64_t now_ns() override;
};

}  // namespace tumblesight::hal::posix
