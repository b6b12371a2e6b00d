// Verifies TS-TIM-080.
#include "hal/posix/realtime.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <thread>

namespace tumblesight::hal::posix {
namespace {

// In a separate thread, so that no other test runs at a fixed priority.
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

TEST(Realtime, ImpossiblePriorityIsReportedNotFatal) {
  std::thread([] {
    EXPECT_EQ(request_realtime(1000).scheduler_error, EINVAL);
    (void)munlockall();
  }).join();
}

}  // namespace
}  // namespace tumblesight::hal::posix
