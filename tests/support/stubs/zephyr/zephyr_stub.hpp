// ZephyrStub: message queues and timers as Zephyr has them, for one thread in virtual time. Time passes only
// while the thread waits, or when a test sets it.
#pragma once

#include <zephyr/kernel.h>

#include <cstdint>
#include <functional>

namespace tumblesight::test {

struct ZephyrStub {
  std::int64_t uptime_ticks = 0;
  // When a thread that has waited is released. May set its time, and with it those of the later releases.
  // False: the timer was stopped meanwhile.
  std::function<bool(std::int64_t& now_ticks)> on_release;
};

// Reset it before each test: zephyr() = {}.
ZephyrStub& zephyr();

}  // namespace tumblesight::test
