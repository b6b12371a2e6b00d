// Verifies TS-SEC-080.
#include "hal/command_queue.hpp"

#include <gtest/gtest.h>

#include "tests/support/make_packet.hpp"

namespace tumblesight::hal {
namespace {

constexpr std::uint8_t kNoop = 1, kSetModeCode = 3, kModelLoad = 5, kSafeMode = 3;
constexpr std::size_t kPlaces = 16;

class CommandQueueTest : public ::testing::Test {
 protected:
  bool put(const std::vector<std::uint8_t>& packet) { return queue.put(packet.data(), packet.size()); }
  std::uint32_t dropped_by(CommandRefusal why) {
    return queue.take_dropped().by[static_cast<std::size_t>(why)];
  }
  std::size_t fill_with(const std::vector<std::uint8_t>& packet) {
    std::size_t taken = 0;
    for (std::size_t i = 0; i < 2 * kPlaces; ++i) taken += put(packet) ? 1 : 0;
    return taken;
  }

  CommandQueue<kPlaces> queue;
  CommandPacket received;
};

TEST_F(CommandQueueTest, DeliversCommandsInOrder) {
  EXPECT_FALSE(queue.receive(received));
  for (std::uint8_t i = 0; i < 3; ++i) EXPECT_TRUE(put(fsw::packet_of(kNoop, {i})));
  for (std::uint8_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(queue.receive(received));
    EXPECT_EQ(received.bytes[kCommandHeaderBytes], i);
    EXPECT_EQ(received.size, kCommandHeaderBytes + 1);
  }
  EXPECT_FALSE(queue.receive(received));
}

TEST_F(CommandQueueTest, KeepsItsLastPlaces) {
  EXPECT_EQ(fill_with(fsw::packet_of(kModelLoad, {0, 0, 0, 0, 1})), kPlaces - CommandFilter::kReserved);
  EXPECT_EQ(fill_with(fsw::packet_of(kNoop)), CommandFilter::kReserved - CommandFilter::kReservedForSafe);
  EXPECT_EQ(fill_with(fsw::packet_of(kSetModeCode, {kSafeMode})), CommandFilter::kReservedForSafe);
  EXPECT_EQ(dropped_by(CommandRefusal::kNoRoom), 6 * kPlaces - kPlaces);
  EXPECT_EQ(dropped_by(CommandRefusal::kNoRoom), 0U);
}

TEST_F(CommandQueueTest, ForgedCommandsTakeNoPlace) {
  queue.authenticate_with(fsw::kTestKeys, 0, 0);
  EXPECT_EQ(fill_with(fsw::packet_of(kNoop)), 0U);
  EXPECT_EQ(dropped_by(CommandRefusal::kForged), 2 * kPlaces);
  const CommandPacket genuine = fsw::signed_with(fsw::kTestKey, 7, fsw::packet_of(kNoop));
  EXPECT_TRUE(queue.put(genuine.bytes.data(), genuine.size));
  EXPECT_FALSE(queue.put(genuine.bytes.data(), genuine.size));
  EXPECT_EQ(dropped_by(CommandRefusal::kReplayed), 1U);
  queue.follow(1, 0);
  const CommandPacket next = fsw::signed_with(fsw::kTestKey, 8, fsw::packet_of(kNoop));
  EXPECT_FALSE(queue.put(next.bytes.data(), next.size));
  EXPECT_EQ(dropped_by(CommandRefusal::kOtherKey), 1U);
}

TEST_F(CommandQueueTest, SizesBeyondAPacketStayVisible) {
  EXPECT_TRUE(put(std::vector<std::uint8_t>(CommandPacket::kMaxBytes + 1)));
  EXPECT_TRUE(put(std::vector<std::uint8_t>(70'000)));
  EXPECT_TRUE(put({}));
  ASSERT_TRUE(queue.receive(received));
  EXPECT_EQ(received.size, CommandPacket::kMaxBytes + 1);
  ASSERT_TRUE(queue.receive(received));
  EXPECT_EQ(received.size, UINT16_MAX);
  ASSERT_TRUE(queue.receive(received));
  EXPECT_EQ(received.size, 0U);
}

}  // namespace
}  // namespace tumblesight::hal
