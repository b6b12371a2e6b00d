#include "hal/dds/mailbox_lock.hpp"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>

namespace tumblesight::hal::dds {
namespace {

// In a mutex that inherits priority, Linux keeps the thread that holds it, so that it can raise its priority.
// In any other mutex that word is 1.
std::uint32_t holder_of(const MailboxMutex& mutex) {
  std::uint32_t word = 0;
  std::memcpy(&word, &mutex.native(), sizeof word);
  constexpr std::uint32_t kThreadId = 0x3FFF'FFFF;
  return word & kThreadId;
}

// Verifies TS-TIM-110.
TEST(MailboxLock, InheritsThePriorityOfTheThreadThatWaits) {
  MailboxMutex mutex;
  EXPECT_TRUE(mutex.inherits_priority());
  EXPECT_EQ(holder_of(mutex), 0U);
  {
    const MailboxLock lock(mutex);
    EXPECT_EQ(holder_of(mutex), static_cast<std::uint32_t>(syscall(SYS_gettid)));
  }
  EXPECT_EQ(holder_of(mutex), 0U);
}

}  // namespace
}  // namespace tumblesight::hal::dds
