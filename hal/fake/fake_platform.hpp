// The small parts of a platform for tests.
#pragma once

#include <functional>

#include "hal/navigation.hpp"
#include "hal/stopwatch.hpp"
#include "hal/watchdog.hpp"

namespace tumblesight::hal::fake {

// FakeNavigation: the chaser's attitude as a function that the test sets. Host only.
class FakeNavigation final : public Navigation {
 public:
  std::function<gnc::ChaserAttitude(std::int64_t)> attitude;

  gnc::ChaserAttitude attitude_at(std::int64_t time_ns) override {
    return attitude ? attitude(time_ns) : gnc::ChaserAttitude{};
  }
};

// FakeStopwatch: its time advances by a fixed amount per call. Host only.
class FakeStopwatch final : public Stopwatch {
 public:
  std::uint64_t now_ns() override {
    time_ns += tick_ns;
    return time_ns;
  }

  std::uint64_t time_ns = 0;
  std::uint64_t tick_ns = 0;  // added at every call; wraps, so that 2^64 - n runs backwards
};

// FakeWatchdog: counts the kicks. Host only.
class FakeWatchdog final : public Watchdog {
 public:
  void kick() override { ++kicks; }
  int kicks = 0;
};

}  // namespace tumblesight::hal::fake
