#include "hal/rtos/rtems/rtems_queue.hpp"

#include <gtest/gtest.h>

#include "tests/support/stubs/rtems/rtems_stub.hpp"

namespace tumblesight::hal::rtos {
namespace {

struct Odd {
  char bytes[3];
};

class RtemsQueueTest : public ::testing::Test {
 protected:
  RtemsQueueTest() { test::rtems() = {}; }

  RtemsQueue<Odd, 2> queue;
  Odd message{{1, 2, 3}};
};

TEST_F(RtemsQueueTest, IsFirstInFirstOut) {
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

TEST_F(RtemsQueueTest, RefusesEverythingBeforeItIsOpen) {
  EXPECT_FALSE(queue.send(message));
  EXPECT_FALSE(queue.receive(message));
  EXPECT_EQ(queue.room(), 0U);
}

TEST_F(RtemsQueueTest, SaysThatTheSystemRefused) {
  for (const rtems_status_code status : {RTEMS_TOO_MANY, RTEMS_UNSATISFIED, RTEMS_INVALID_SIZE}) {
    test::rtems().refusals["rtems_message_queue_construct"] = status;
    EXPECT_FALSE(queue.open()) << status;
  }
}

}  // namespace
}  // namespace tumblesight::hal::rtos
