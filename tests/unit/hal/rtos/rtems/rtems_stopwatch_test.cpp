#include "hal/rtos/rtems/rtems_stopwatch.hpp"

#include <gtest/gtest.h>

#include "tests/support/stubs/rtems/rtems_stub.hpp"

namespace tumblesight::hal::rtos {
namespace {

TEST(RtemsStopwatch, IsTheUptime) {
  test::rtems() = {};
  test::rtems().uptime_ns = 123'456'789'012'345;
  EXPECT_EQ(RtemsStopwatch().now_ns(), 123'456'789'012'345U);
}

}  // namespace
}  // namespace tumblesight::hal::rtos
