#include "hal/fixed_queue.hpp"

#include <gtest/gtest.h>

namespace tumblesight::hal {
namespace {

TEST(FixedQueue, ReturnsEntriesInOrder) {
  FixedQueue<int, 3> queue;
  EXPECT_EQ(queue.pop(), nullptr);
  for (int round = 0; round < 5; ++round) {
    queue.push() = 2 * round;
    queue.push() = 2 * round + 1;
    EXPECT_EQ(*queue.pop(), 2 * round);
    EXPECT_EQ(*queue.pop(), 2 * round + 1);
    EXPECT_EQ(queue.pop(), nullptr);
  }
}

TEST(FixedQueue, DropsTheOldestEntryWhenFull) {
  FixedQueue<int, 3> queue;
  for (int i = 0; i < 5; ++i) queue.push() = i;
  EXPECT_EQ(*queue.pop(), 2);
  EXPECT_EQ(*queue.pop(), 3);
  EXPECT_EQ(*queue.pop(), 4);
  EXPECT_EQ(queue.pop(), nullptr);
}

}  // namespace
}  // namespace tumblesight::hal
