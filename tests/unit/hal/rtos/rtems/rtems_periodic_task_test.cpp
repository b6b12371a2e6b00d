#include "hal/rtos/rtems/rtems_periodic_task.hpp"

#include <gtest/gtest.h>

#include "tests/support/stubs/rtems/rtems_stub.hpp"

namespace tumblesight::hal::rtos {
namespace {

constexpr std::int64_t kPeriod_ns = 2'700'000'000;

class RtemsPeriodicTaskTest : public ::testing::Test {
 protected:
  RtemsPeriodicTaskTest() {
    test::rtems() = {};
    test::rtems().uptime_ns = 1'000;
  }
  std::int64_t wait() { return task.wait_next_release_ns(slips); }

  RtemsPeriodicTask task;
  std::uint32_t slips = 0;
};

TEST_F(RtemsPeriodicTaskTest, ReleasesStayOnTheGridForAnyLengthOfCycle) {
  ASSERT_TRUE(task.start(kPeriod_ns));
  for (int k = 1; k < 10; ++k) {
    EXPECT_EQ(wait(), 1'000 + k * kPeriod_ns);
    test::rtems().uptime_ns += k % 3 * 1'000'000'000;
  }
  EXPECT_EQ(slips, 0U);
  EXPECT_TRUE(task.is_running());
}

TEST_F(RtemsPeriodicTaskTest, PassedReleasesAreCountedAndTheLatestIsServedAtOnce) {
  ASSERT_TRUE(task.start(kPeriod_ns));
  test::rtems().uptime_ns += 7 * kPeriod_ns / 2;  // releases 1, 2 and 3 have passed
  const std::int64_t late_ns = test::rtems().uptime_ns;
  EXPECT_EQ(wait(), late_ns);
  EXPECT_EQ(slips, 3U);
  EXPECT_EQ(wait(), 1'000 + 4 * kPeriod_ns) << "back on the grid";
  test::rtems().uptime_ns += kPeriod_ns;  // one has just passed
  EXPECT_EQ(wait(), 1'000 + 5 * kPeriod_ns);
  EXPECT_EQ(slips, 4U);
}

TEST_F(RtemsPeriodicTaskTest, SkipsAThousandReleasesInOneCallAtMost) {
  ASSERT_TRUE(task.start(kPeriod_ns));
  test::rtems().uptime_ns += 1'500 * kPeriod_ns;
  static_cast<void>(wait());
  EXPECT_EQ(slips, 1'000U);
  static_cast<void>(wait());
  EXPECT_EQ(slips, 1'500U);
  EXPECT_TRUE(task.is_running());
}

TEST_F(RtemsPeriodicTaskTest, CountsOneReleaseIfTheStatusIsNotKnown) {
  ASSERT_TRUE(task.start(kPeriod_ns));
  test::rtems().uptime_ns += 3 * kPeriod_ns;
  test::rtems().refusals["rtems_rate_monotonic_get_status"] = RTEMS_INVALID_ID;
  static_cast<void>(wait());
  EXPECT_EQ(slips, 1U);
  EXPECT_TRUE(task.is_running());
}

TEST_F(RtemsPeriodicTaskTest, RefusesPeriodsThatAreNotWholeTicks) {
  for (const std::int64_t period_ns :
       {std::int64_t{0}, -kPeriod_ns, kPeriod_ns + 1, std::int64_t{10'000'000} << 32})
    EXPECT_FALSE(task.start(period_ns)) << period_ns;
  EXPECT_TRUE(test::rtems().periods.empty());
}

TEST_F(RtemsPeriodicTaskTest, SaysThatTheSystemRefused) {
  test::rtems().limits.periods = 0;
  EXPECT_FALSE(task.start(kPeriod_ns));
  test::rtems().limits.periods = 1;
  test::rtems().refusals["rtems_rate_monotonic_period"] = RTEMS_INVALID_ID;
  EXPECT_FALSE(task.start(kPeriod_ns));
  EXPECT_FALSE(task.is_running());
  test::rtems().refusals.clear();
  EXPECT_TRUE(task.start(kPeriod_ns)) << "another try";
  EXPECT_EQ(test::rtems().periods.size(), 1U);
}

TEST_F(RtemsPeriodicTaskTest, DoesNotRunAfterTheSystemRefusedToWait) {
  static_cast<void>(wait());
  EXPECT_FALSE(task.is_running()) << "not started";
  ASSERT_TRUE(task.start(kPeriod_ns));
  test::rtems().refusals["rtems_rate_monotonic_period"] = RTEMS_INVALID_ID;
  static_cast<void>(wait());
  EXPECT_FALSE(task.is_running());
  EXPECT_EQ(slips, 0U);
}

TEST_F(RtemsPeriodicTaskTest, GivesItsPeriodBack) {
  {
    RtemsPeriodicTask other;
    ASSERT_TRUE(other.start(kPeriod_ns));
    EXPECT_EQ(test::rtems().periods.size(), 1U);
  }
  EXPECT_TRUE(test::rtems().periods.empty());
}

}  // namespace
}  // namespace tumblesight::hal::rtos
