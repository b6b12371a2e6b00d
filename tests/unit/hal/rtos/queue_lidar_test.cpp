#include "hal/rtos/queue_lidar.hpp"

#include <memory>
#include <set>

#include "tests/unit/hal/rtos/systems.hpp"

namespace tumblesight::hal::rtos {
namespace {

template <class System>
class QueueLidarTest : public ::testing::Test {
 protected:
  using Lidar = QueueLidar<System::template Queue>;

  QueueLidarTest() {
    test::rtems() = {};
    EXPECT_TRUE(lidar->open());
  }
  void deliver(std::uint32_t number, std::uint16_t rays = 16) {
    gnc::RangeImage* const buffer = lidar->begin_frame();
    ASSERT_NE(buffer, nullptr);
    buffer->sequence_number = number;
    buffer->rays = rays;
    lidar->end_frame(buffer);
  }

  std::unique_ptr<Lidar> lidar = std::make_unique<Lidar>();
  std::unique_ptr<gnc::RangeImage> frame = std::make_unique<gnc::RangeImage>();
};

TYPED_TEST_SUITE(QueueLidarTest, Systems);

TYPED_TEST(QueueLidarTest, DeliversFramesInOrderForEver) {
  for (std::uint32_t number = 0; number < 20; number += 2) {
    this->deliver(number);
    this->deliver(number + 1);
    for (const std::uint32_t expected : {number, number + 1}) {
      ASSERT_EQ(this->lidar->receive(*this->frame), LidarStatus::kFrame);
      EXPECT_EQ(this->frame->sequence_number, expected);
    }
    EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kNoFrame);
  }
  EXPECT_EQ(this->lidar->take_dropped(), 0U);
}

TYPED_TEST(QueueLidarTest, DropsTheOldestFramesAndCountsThem) {
  for (std::uint32_t number = 0; number < 7; ++number) this->deliver(number);
  EXPECT_EQ(this->lidar->take_dropped(), 3U);
  EXPECT_EQ(this->lidar->take_dropped(), 0U);
  for (std::uint32_t number = 3; number < 7; ++number) {
    ASSERT_EQ(this->lidar->receive(*this->frame), LidarStatus::kFrame);
    EXPECT_EQ(this->frame->sequence_number, number);
  }
}

TYPED_TEST(QueueLidarTest, ABufferHasOneUserAtATime) {
  std::set<gnc::RangeImage*> buffers;
  for (std::size_t i = 0; i < TestFixture::Lidar::kBuffers; ++i) {
    gnc::RangeImage* const buffer = this->lidar->begin_frame();
    buffers.insert(buffer);
    buffer->rays = 16;
    this->lidar->end_frame(buffer);
  }
  EXPECT_EQ(buffers.size(), TestFixture::Lidar::kBuffers);
}

// More often than there are buffers: none is lost.
TYPED_TEST(QueueLidarTest, AFrameThatIsNotEndedIsGivenUp) {
  gnc::RangeImage* const first = this->lidar->begin_frame();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(this->lidar->begin_frame(), first) << i;
  for (std::uint32_t number = 0; number < 20; ++number) {
    ASSERT_NE(this->lidar->begin_frame(), nullptr);  // given up
    this->deliver(number);
    ASSERT_EQ(this->lidar->receive(*this->frame), LidarStatus::kFrame);
    EXPECT_EQ(this->frame->sequence_number, number);
    EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kNoFrame);
  }
  EXPECT_EQ(this->lidar->take_dropped(), 0U);
  for (std::uint32_t number = 0; number < TestFixture::Lidar::kBuffers; ++number) this->deliver(number);
  EXPECT_EQ(this->lidar->take_dropped(), 0U) << "all buffers are still there";
}

TYPED_TEST(QueueLidarTest, EndsOnlyTheFrameThatWasBegun) {
  gnc::RangeImage foreign;
  this->lidar->end_frame(nullptr);
  this->lidar->end_frame(&foreign);
  EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kNoFrame) << "none was begun";
  gnc::RangeImage* const buffer = this->lidar->begin_frame();
  buffer->rays = 16;
  this->lidar->end_frame(nullptr);
  this->lidar->end_frame(buffer + 1);
  this->lidar->end_frame(&foreign);
  EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kNoFrame) << "not this one";
  this->lidar->end_frame(buffer);
  this->lidar->end_frame(buffer);
  EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kFrame);
  EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kNoFrame) << "once";
  for (std::uint32_t number = 0; number < 8; ++number) this->deliver(number);
  EXPECT_EQ(this->lidar->take_dropped(), 8U - TestFixture::Lidar::kBuffers);
}

TYPED_TEST(QueueLidarTest, SaysThatAFrameHasAWrongSize) {
  this->deliver(1, 0);
  this->deliver(2, gnc::RangeImage::kMaxRays + 1);
  this->deliver(3, gnc::RangeImage::kMaxRays);
  EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kWrongSize);
  EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kWrongSize);
  EXPECT_EQ(this->lidar->receive(*this->frame), LidarStatus::kFrame);
}

using RtemsLidarTest = QueueLidarTest<Rtems>;

TEST_F(RtemsLidarTest, DoesNotOpenWithTooFewQueues) {
  for (std::uint32_t queues = 0; queues < 3; ++queues) {
    test::rtems() = {};
    test::rtems().limits.message_queues = queues;
    EXPECT_FALSE(lidar->open()) << queues;
  }
}

TEST_F(RtemsLidarTest, CountsAFrameThatTheSystemRefuses) {
  gnc::RangeImage* const buffer = lidar->begin_frame();
  test::rtems().refusals["rtems_message_queue_send"] = RTEMS_INVALID_ID;
  lidar->end_frame(buffer);
  test::rtems().refusals.clear();
  EXPECT_EQ(lidar->receive(*frame), LidarStatus::kNoFrame);
  static_cast<void>(lidar->take_dropped());  // the queue of this count may refuse, too
  for (std::uint32_t number = 0; number < Lidar::kBuffers; ++number) deliver(number);
  EXPECT_EQ(lidar->take_dropped(), 0U) << "its buffer is not lost";
}

TEST_F(RtemsLidarTest, ABufferThatTheSystemDoesNotTakeBackIsGivenBackLater) {
  for (std::uint32_t round = 0; round < 2 * Lidar::kBuffers; ++round) {
    deliver(round);
    test::rtems().refusals["rtems_message_queue_send"] = RTEMS_INVALID_ID;
    EXPECT_EQ(lidar->receive(*frame), LidarStatus::kFrame);
    EXPECT_EQ(lidar->receive(*frame), LidarStatus::kNoFrame);
    test::rtems().refusals.clear();
    EXPECT_EQ(lidar->receive(*frame), LidarStatus::kNoFrame) << "the buffer is given back";
  }
  for (std::uint32_t number = 0; number < Lidar::kBuffers; ++number) deliver(number);
  EXPECT_EQ(lidar->take_dropped(), 0U);
}

}  // namespace
}  // namespace tumblesight::hal::rtos
