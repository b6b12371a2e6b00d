#include "hal/dds/idl/wait_limit.hpp"

#include <gtest/gtest.h>

namespace tumblesight::hal::dds {
namespace {

constexpr std::uint64_t kSecond_ns = 1'000'000'000, kPoll_ns = kSecond_ns / 10;

TEST(WaitLimit, IsOverAfterItsTime) {
  WaitLimit limit(7 * kSecond_ns, 3 * kSecond_ns);
  std::uint64_t now_ns = 7 * kSecond_ns;
  for (; now_ns < 10 * kSecond_ns; now_ns += kPoll_ns) EXPECT_FALSE(limit.is_over(now_ns));
  EXPECT_TRUE(limit.is_over(10 * kSecond_ns + 1));
}

TEST(WaitLimit, DoesNotCountAPauseOfItsProcess) {
  WaitLimit limit(0, 3 * kSecond_ns);
  EXPECT_FALSE(limit.is_over(kSecond_ns / 2));
  EXPECT_FALSE(limit.is_over(4000 * kSecond_ns)) << "1.5 s of waiting";
  EXPECT_FALSE(limit.is_over(4001 * kSecond_ns)) << "2.5 s of waiting";
  EXPECT_TRUE(limit.is_over(4002 * kSecond_ns));
}

}  // namespace
}  // namespace tumblesight::hal::dds
