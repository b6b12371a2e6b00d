#include "fsw/app/counter.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tumblesight::fsw {
namespace {

constexpr std::int64_t kNow_ns = 1'000'000'000'000;
constexpr std::int64_t kLowest_ns = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kHighest_ns = std::numeric_limits<std::int64_t>::max();

TEST(Counter, SaturatesInsteadOfWrapping) {
  std::uint32_t counter = UINT32_MAX - 2;
  count(counter);
  EXPECT_EQ(counter, UINT32_MAX - 1);
  count(counter, 5);
  EXPECT_EQ(counter, UINT32_MAX);
  count(counter);
  EXPECT_EQ(counter, UINT32_MAX);
}

TEST(ElapsedMs, Saturates) {
  EXPECT_EQ(elapsed_ms(kLowest_ns, kHighest_ns), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(elapsed_ms(kHighest_ns, kLowest_ns), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(elapsed_ms(kNow_ns, kNow_ns - 3'000'000), -3);
}

}  // namespace
}  // namespace tumblesight::fsw
