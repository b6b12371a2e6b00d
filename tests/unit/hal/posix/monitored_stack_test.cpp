// Verifies TS-MEM-100.
#include "hal/posix/monitored_stack.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

namespace tumblesight::hal::posix {
namespace {

constexpr std::size_t kDeep = 100'000;

[[gnu::noinline]] void use_deep_stack() {
  unsigned char bytes[kDeep];
  std::memset(bytes, 1, sizeof bytes);
  asm volatile("" : : "r"(bytes) : "memory");  // keeps the array
}

void* go_deep(void*) {
  use_deep_stack();
  return nullptr;
}

void* stay_shallow(void*) {
  return nullptr;
}

std::uint32_t left_after(void* (*main)(void*)) {
  const auto stack = std::make_unique<MonitoredStack>();
  EXPECT_EQ(stack->least_left_bytes(), MonitoredStack::kBytes) << "before there is a thread";
  pthread_t thread{};
  EXPECT_TRUE(stack->start(thread, main, nullptr));
  EXPECT_EQ(pthread_join(thread, nullptr), 0);
  return stack->least_left_bytes();
}

TEST(MonitoredStack, ShowsTheGreatestDepthOfItsThread) {
  const std::uint32_t shallow = left_after(stay_shallow);
  const std::uint32_t deep = left_after(go_deep);
  EXPECT_GT(shallow, MonitoredStack::kBytes / 2);
  EXPECT_LT(shallow, MonitoredStack::kBytes);
  EXPECT_LE(deep, MonitoredStack::kBytes - kDeep);
  EXPECT_GT(deep, shallow - kDeep - kDeep / 10);
}

}  // namespace
}  // namespace tumblesight::hal::posix
