#include "hal/rtos/zephyr/zephyr_stopwatch.hpp"

#include <gtest/gtest.h>

#include "tests/support/stubs/zephyr/zephyr_stub.hpp"

namespace tumblesight::hal::rtos {
namespace {

TEST(ZephyrStopwatch, IsTheUptimeInWholeTicks) {
  test::zephyr() = {};
  test::zephyr().uptime_ticks = 1'234'567;
  EXPECT_EQ(ZephyrStopwatch().now_ns(), 123'456'700'000U);
}

}  // namespace
}  // namespace tumblesight::hal::rtos
