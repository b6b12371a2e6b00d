#include "hal/rtos/queue_link.hpp"

#include <memory>

#include "tests/support/make_packet.hpp"
#include "tests/unit/hal/rtos/systems.hpp"

namespace tumblesight::hal::rtos {
namespace {

constexpr std::uint8_t kNoop = 1, kSetMode = 3, kModelLoad = 5;

template <class System>
class QueueLinkTest : public ::testing::Test {
 protected:
  using Link = QueueLink<System::template Queue>;

  QueueLinkTest() {
    test::rtems() = {};
    EXPECT_TRUE(link->open());
  }
  static CommandPacket command(std::uint8_t argument) {
    return fsw::unsigned_packet(fsw::packet_of(kNoop, {argument}));
  }
  std::uint32_t dropped_by(CommandRefusal why) {
    return link->take_dropped().by[static_cast<std::size_t>(why)];
  }
  int next_apid() {
    packets::TelemetryPacket packet;
    return link->take(packet) ? (packet.bytes[0] & 7) * 256 + packet.bytes[1] : 0;
  }

  std::unique_ptr<Link> link = std::make_unique<Link>();
  CommandPacket received;
};

TYPED_TEST_SUITE(QueueLinkTest, Systems);

TYPED_TEST(QueueLinkTest, DeliversCommandsInOrder) {
  EXPECT_FALSE(this->link->receive(this->received));
  for (std::uint8_t i = 0; i < 3; ++i) this->link->put(this->command(i));
  for (std::uint8_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(this->link->receive(this->received));
    EXPECT_EQ(this->received.bytes, this->command(i).bytes);
    EXPECT_EQ(this->received.size, this->command(i).size);
  }
  EXPECT_FALSE(this->link->receive(this->received));
}

TYPED_TEST(QueueLinkTest, CountsCommandsForWhichThereIsNoRoomOnce) {
  for (int i = 0; i < 20; ++i) this->link->put(this->command(0));
  EXPECT_EQ(this->dropped_by(CommandRefusal::kNoRoom), 4U + CommandFilter::kReservedForSafe);
  EXPECT_EQ(this->dropped_by(CommandRefusal::kNoRoom), 0U);
}

// Each flood fills the queue as far as it can. The application takes eight commands per cycle.
TYPED_TEST(QueueLinkTest, NothingKeepsSetModeSafeOut) {
  const std::vector<std::uint8_t> segment(4 + 1024);
  for (const std::vector<std::uint8_t>& flood :
       {fsw::packet_of(kModelLoad, segment), fsw::packet_of(kNoop), fsw::packet_of(kSetMode, {2}),
        std::vector<std::uint8_t>(12)}) {
    for (int i = 0; i < 40; ++i) this->link->put(fsw::unsigned_packet(flood));
    const CommandPacket safe = fsw::unsigned_packet(fsw::packet_of(kSetMode, {3}));
    this->link->put(safe);
    bool arrived = false;
    for (int i = 0; i < 2 * 8 && this->link->receive(this->received); ++i)
      arrived |= this->received.size == safe.size && this->received.bytes == safe.bytes;
    EXPECT_TRUE(arrived) << int{flood[6]};
    EXPECT_FALSE(this->link->receive(this->received));
  }
}

TYPED_TEST(QueueLinkTest, KeepsPlacesForOtherCommandsThanSegmentsOfAModel) {
  const CommandPacket segment = fsw::unsigned_packet(fsw::packet_of(kModelLoad));
  for (int i = 0; i < 20; ++i) this->link->put(segment);
  EXPECT_EQ(this->dropped_by(CommandRefusal::kNoRoom), 20U - 16U + CommandFilter::kReserved);
  this->link->put(this->command(0));
  EXPECT_EQ(this->dropped_by(CommandRefusal::kNoRoom), 0U);
}

// Verifies TS-SEC-080.
TYPED_TEST(QueueLinkTest, ForgedCommandsTakeNoPlace) {
  this->link->authenticate_with(fsw::kTestKeys, 0, 0);
  for (int i = 0; i < 100; ++i) this->link->put(this->command(0));
  this->link->put(fsw::signed_with(fsw::kTestKey, 1, fsw::packet_of(kNoop)));
  EXPECT_EQ(this->dropped_by(CommandRefusal::kForged), 100U);
  EXPECT_TRUE(this->link->receive(this->received));
  EXPECT_FALSE(this->link->receive(this->received));
}

TYPED_TEST(QueueLinkTest, FollowsTheKeyOfTheNewestTelemetry) {
  this->link->authenticate_with(fsw::kTestKeys, 0, 0);
  this->link->publish(Telemetry{});
  Telemetry telemetry;
  telemetry.key_slot = 1;
  telemetry.command_counter = 7;
  this->link->publish(telemetry);
  fsw::Signature second;
  second.key = fsw::kSecondTestKey;
  second.slot = 1;
  this->link->put(fsw::signed_as(second, 7, fsw::packet_of(kNoop)));
  EXPECT_EQ(this->dropped_by(CommandRefusal::kReplayed), 1U);
  this->link->put(fsw::signed_as(second, 8, fsw::packet_of(kNoop)));
  EXPECT_TRUE(this->link->receive(this->received));
}

TYPED_TEST(QueueLinkTest, SendsEachMessageAsAPacketInOrder) {
  this->link->publish(AttitudeReport{});
  this->link->publish(Telemetry{});
  this->link->publish(Event{});
  this->link->publish(MemoryDump{});
  for (const int apid : {0x1F1, 0x1F2, 0x1F3, 0x1F4, 0}) EXPECT_EQ(this->next_apid(), apid);
  EXPECT_EQ(this->link->packets_lost(), 0U);
}

TYPED_TEST(QueueLinkTest, CountsPacketsForWhichThereIsNoRoom) {
  for (int i = 0; i < 43; ++i) this->link->publish(Event{});
  EXPECT_EQ(this->link->packets_lost(), 3U);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(this->next_apid(), 0x1F3);
  EXPECT_EQ(this->next_apid(), 0);
}

using RtemsLinkTest = QueueLinkTest<Rtems>;

TEST_F(RtemsLinkTest, DoesNotOpenWithTooFewQueues) {
  for (std::uint32_t queues = 0; queues < 4; ++queues) {
    test::rtems() = {};
    test::rtems().limits.message_queues = queues;
    EXPECT_FALSE(link->open()) << queues;
  }
}

TEST_F(RtemsLinkTest, CountsACommandThatTheSystemRefuses) {
  test::rtems().refusals["rtems_message_queue_send"] = RTEMS_INVALID_ID;
  link->put(command(0));
  test::rtems().refusals.clear();
  EXPECT_FALSE(link->receive(received));
  link->put(command(0));
  EXPECT_TRUE(link->receive(received));
}

}  // namespace
}  // namespace tumblesight::hal::rtos
