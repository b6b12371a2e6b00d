#include "hal/rtos/zephyr/zephyr_periodic_task.hpp"

#include <gtest/gtest.h>

#include "tests/support/stubs/zephyr/zephyr_stub.hpp"

namespace tumblesight::hal::rtos {
namespace {

constexpr std::int64_t kPeriod_ns = 2'700'000'000;
constexpr std::int64_t kPeriod_ticks = kPeriod_ns / STUB_NS_PER_TICK;
constexpr std::int64_t kStart_ticks = 10;
constexpr std::int64_t kStart_ns = kStart_ticks * STUB_NS_PER_TICK;

class ZephyrPeriodicTaskTest : public ::testing::Test {
 protected:
  ZephyrPeriodicTaskTest() {
    test::zephyr() = {};
    test::zephyr().uptime_ticks = kStart_ticks;
  }
  std::int64_t wait() { return task.wait_next_release_ns(slips); }

  ZephyrPeriodicTask task;
  std::uint32_t slips = 0;
};

TEST_F(ZephyrPeriodicTaskTest, ReleasesStayOnTheGridForAnyLengthOfCycle) {
  ASSERT_TRUE(task.start(kPeriod_ns));
  for (int k = 1; k < 10; ++k) {
    EXPECT_EQ(wait(), kStart_ns + k * kPeriod_ns);
    test::zephyr().uptime_ticks += k % 3 * 10'000;
  }
  EXPECT_EQ(slips, 0U);
  EXPECT_TRUE(task.is_running());
}

TEST_F(ZephyrPeriodicTaskTest, PassedReleasesAreCountedAndTheLatestIsServedAtOnce) {
  ASSERT_TRUE(task.start(kPeriod_ns));
  test::zephyr().uptime_ticks += 7 * kPeriod_ticks / 2;  // releases 1, 2 and 3 have passed
  EXPECT_EQ(wait(), kStart_ns + 7 * kPeriod_ns / 2);
  EXPECT_EQ(slips, 3U);
  EXPECT_EQ(wait(), kStart_ns + 4 * kPeriod_ns) << "back on the grid";
  EXPECT_EQ(slips, 3U);
}

TEST_F(ZephyrPeriodicTaskTest, RefusesPeriodsThatAreNotPositive) {
  EXPECT_FALSE(task.start(0));
  EXPECT_FALSE(task.start(-kPeriod_ns));
  EXPECT_FALSE(task.is_running());
}

TEST_F(ZephyrPeriodicTaskTest, DoesNotRunAfterItsTimerWasStopped) {
  static_cast<void>(wait());
  EXPECT_FALSE(task.is_running()) << "not started";
  ASSERT_TRUE(task.start(kPeriod_ns));
  test::zephyr().on_release = [](std::int64_t&) { return false; };
  static_cast<void>(wait());
  EXPECT_FALSE(task.is_running()) << "stopped while it waited";
  ASSERT_TRUE(task.start(kPeriod_ns));
  task.stop();
  EXPECT_FALSE(task.is_running());
  EXPECT_TRUE(task.start(kPeriod_ns)) << "another try";
}

}  // namespace
}  // namespace tumblesight::hal::rtos
