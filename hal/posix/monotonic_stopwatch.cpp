#include "hal/posix/monotonic_stopwatch.hpp"

#include <time.h>

namespace tumblesight::hal::posix {

std::uint64_t MonotonicStopwatch::now_ns() {
  timespec now{};
  (void)clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(now.tv_nsec);
}

}  // namespace tumblesight::hal::posix
