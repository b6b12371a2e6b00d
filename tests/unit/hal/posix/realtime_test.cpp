#include "hal/posix/realtime.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <cerrno>
#include <thread>

#include "hal/posix/monotonic_stopwatch.hpp"

namespace tumblesight::hal::posix {

namespace {

// In a separate thread, so that no other test runs at a fixed priority.
// Verifies TS-TIM-080.
TEST(Realtime, GrantMatchesTheThreadsScheduling) {
  std::thread([] {
    const RealtimeGrant grant = request_realtime(10);
    (void)munlockall();
    int policy = 0;
    sched_param parameters{};
    ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &parameters), 0);
    EXPECT_EQ(policy == SCHED_FIFO, grant.scheduler_error == 0);
    if (grant.scheduler_error == 0) {
      EXPECT_EQ(parameters.sched_priority, 10);
    } else {
      EXPECT_EQ(grant.scheduler_error, EPERM);
    }
    if (grant.memory_lock_error != 0) {
      EXPECT_TRUE(grant.memory_lock_error == EPERM || grant.memory_lock_error == ENOMEM ||
                  grant.memory_lock_error == EAGAIN)
          << grant.memory_lock_error;
    }
  }).join();
}

// Verifies TS-TIM-080.
TEST(Realtime, ImpossiblePriorityIsReportedNotFatal) {
  std::thread([] {
    EXPECT_EQ(request_realtime(1000).scheduler_error, EINVAL);
    (void)munlockall();
  }).join();
}

constexpr std::int64_t kMillisecond_ns = 1'000'000;

std::int64_t now_ns() {
  return static_cast<std::int64_t>(MonotonicStopwatch().now_ns());
}

void be_busy_until(std::int64_t time_ns) {
  while (now_ns() < time_ns) {
    const timespec pause{0, 500'000};
    nanosleep(&pause, nullptr);
  }
}

// Verifies TS-TIM-070.
TEST(PosixPeriodicTask, ReleasesStayOnTheGridForAnyLengthOfCycle) {
  const std::int64_t period_ns = 50 * kMillisecond_ns;
  const std::int64_t first_ns = now_ns() + period_ns;
  PosixPeriodicTask task(first_ns, period_ns);
  std::uint32_t slips = 0;
  std::int64_t last_ns = 0;
  for (int k = 0; k < 8; ++k) {
    const std::int64_t release_ns = task.wait_next_release_ns(slips);
    EXPECT_EQ((release_ns - first_ns) % period_ns, 0) << "absolute times: no drift";
    EXPECT_GE(now_ns(), release_ns) << "never early";
    EXPECT_GT(release_ns, last_ns);
    last_ns = release_ns;
    be_busy_until(release_ns + (k % 3) * 10 * kMillisecond_ns);
  }
  // On a loaded machine releases can be skipped. Each of them is counted.
  EXPECT_GE((last_ns - first_ns) / period_ns, 7);
  EXPECT_LE((last_ns - first_ns) / period_ns, 7 + static_cast<std::int64_t>(slips));
}

// Verifies TS-TIM-070.
TEST(PosixPeriodicTask, PassedReleasesAreCountedAndTheLatestIsServedAtOnce) {
  const std::int64_t period_ns = 1'000 * kMillisecond_ns;
  const std::int64_t first_ns = now_ns() - 5 * period_ns / 2;  // releases 0, 1 and 2 have passed
  PosixPeriodicTask task(first_ns, period_ns);
  std::uint32_t slips = 10;
  EXPECT_EQ(task.wait_next_release_ns(slips), first_ns + 2 * period_ns);
  EXPECT_EQ(slips, 13U);
  EXPECT_LT(now_ns(), first_ns + 3 * period_ns) << "it must not wait for the next one";
  slips = UINT32_MAX - 1;
  PosixPeriodicTask another(first_ns, period_ns);
  (void)another.wait_next_release_ns(slips);
  EXPECT_EQ(slips, UINT32_MAX) << "saturates";
}

// Verifies TS-TIM-070.
TEST(PosixPeriodicTask, PunctualTaskDoesNotSlip) {
  const std::int64_t period_ns = 400 * kMillisecond_ns;
  PosixPeriodicTask task(now_ns() + period_ns, period_ns);
  std::uint32_t slips = 0;
  const std::int64_t first_ns = task.wait_next_release_ns(slips);
  EXPECT_EQ(task.wait_next_release_ns(slips), first_ns + period_ns);
  EXPECT_EQ(slips, 0U);
}

TEST(PosixPeriodicTask, TooShortPeriodIsRaisedToTheMinimum) {
  const std::int64_t first_ns = now_ns();
  PosixPeriodicTask task(first_ns, -1);
  std::uint32_t slips = 0;
  const std::int64_t release_ns = task.wait_next_release_ns(slips);
  EXPECT_EQ((release_ns - first_ns) % PosixPeriodicTask::kMinPeriod_ns, 0);
  EXPECT_GT(task.wait_next_release_ns(slips), release_ns);
}

TEST(MonotonicStopwatch, MeasuresASleep) {
  MonotonicStopwatch stopwatch;
  const std::uint64_t start_ns = stopwatch.now_ns();
  const timespec pause{0, 20'000'000};
  nanosleep(&pause, nullptr);
  const std::uint64_t elapsed_ns = stopwatch.now_ns() - start_ns;
  EXPECT_GE(elapsed_ns, 20'000'000U);
  EXPECT_LT(elapsed_ns, 20'000'000'000U);
}

}  // namespace

}  // namespace tumblesight::hal::posix
