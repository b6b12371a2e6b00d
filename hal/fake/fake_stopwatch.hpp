// FakeStopwatch: its time advances by a fixed amount per call. Host only.
#pragma once

#include "hal/stopwatch.hpp"

namespace tumblesight::hal::fake {

class FakeStopwatch final : public Stopwatch {
 public:
  std::uint64_t now_ns() override {
    time_ns += tick_ns;
    return time_ns;
  }

  std::uint64_t time_ns = 0;
  std::uint64_t tick_ns = 0;  // added at every call; wraps, so that 2^64 - n runs backwards
};

}  // namespace tumblesight::hal::fake
