#include "hal/rtos/missed_releases.hpp"

#include <gtest/gtest.h>

namespace tumblesight::hal::rtos {
namespace {

TEST(MissedReleases, AddUpAndSaturate) {
  std::uint32_t slips = 2;
  add_missed(0, slips);
  EXPECT_EQ(slips, 2U);
  add_missed(3, slips);
  EXPECT_EQ(slips, 5U);
  add_missed(UINT32_MAX - 5, slips);
  EXPECT_EQ(slips, UINT32_MAX);
  add_missed(1, slips);
  EXPECT_EQ(slips, UINT32_MAX);
}

}  // namespace
}  // namespace tumblesight::hal::rtos
