#include "hal/rtos/zephyr/zephyr_queue.hpp"

#include <gtest/gtest.h>

namespace tumblesight::hal::rtos {
namespace {

struct Odd {
  char bytes[3];
};

TEST(ZephyrQueue, IsFirstInFirstOut) {
  ZephyrQueue<Odd, 2> queue;
  Odd message{};
  ASSERT_TRUE(queue.open());
  EXPECT_EQ(queue.room(), 2U);
  EXPECT_TRUE(queue.send({{1, 2, 3}}));
  EXPECT_TRUE(queue.send({{4, 5, 6}}));
  EXPECT_EQ(queue.room(), 0U);
  EXPECT_FALSE(queue.send({{7, 8, 9}})) << "full";
  EXPECT_TRUE(queue.receive(message));
  EXPECT_EQ(message.bytes[2], 3);
  EXPECT_TRUE(queue.receive(message));
  EXPECT_EQ(message.bytes[2], 6);
  EXPECT_FALSE(queue.receive(message)) << "empty";
}

TEST(ZephyrQueue, RefusesEverythingBeforeItIsOpen) {
  ZephyrQueue<Odd, 2> queue;
  Odd message{};
  EXPECT_FALSE(queue.send(message));
  EXPECT_FALSE(queue.receive(message));
  EXPECT_EQ(queue.room(), 0U);
}

}  // namespace
}  // namespace tumblesight::hal::rtos
