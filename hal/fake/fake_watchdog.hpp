// FakeWatchdog: counts the kicks. Host only.
#pragma once

#include "hal/watchdog.hpp"

namespace tumblesight::hal::fake {

class FakeWatchdog final : public Watchdog {
 public:
  void kick() override { ++kicks; }
  int kicks = 0;
};

}  // namespace tumblesight::hal::fake
