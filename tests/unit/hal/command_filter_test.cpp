// Verifies TS-SEC-080.
#include "hal/command_filter.hpp"

#include <gtest/gtest.h>

#include "tests/support/make_packet.hpp"

namespace tumblesight::hal {

struct CommandFilterMemory {
  static constexpr std::size_t kBits = 8 * sizeof(CommandFilter::State);
  static void flip(CommandFilter& filter, std::size_t copy, std::size_t bit) {
    auto* bytes = reinterpret_cast<std::uint8_t*>(&filter.copies_[copy]);
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
};

namespace {

CommandPacket noop(std::uint32_t counter, const fsw::Signature& signature = {}) {
  return fsw::signed_as(signature, counter, fsw::packet_of(1));
}

class CommandFilterTest : public ::testing::Test {
 protected:
  CommandFilterTest() { filter.authenticate_with(fsw::kTestKeys, 0, 10); }
  std::uint32_t dropped_by(CommandRefusal why) {
    return filter.take_dropped().by[static_cast<std::size_t>(why)];
  }
  CommandFilter filter;
};

TEST_F(CommandFilterTest, LetsEachGenuineCommandPassOnce) {
  EXPECT_TRUE(filter.passes(noop(11), 16));
  EXPECT_FALSE(filter.passes(noop(11), 16));
  EXPECT_EQ(dropped_by(CommandRefusal::kReplayed), 1U);
  EXPECT_TRUE(filter.passes(noop(12), 16));
  EXPECT_FALSE(filter.passes(noop(10), 16));
  EXPECT_EQ(dropped_by(CommandRefusal::kReplayed), 1U) << "the counts are taken";
}

TEST_F(CommandFilterTest, DropsAndCountsEverythingElse) {
  fsw::Signature other_key, other_slot;
  other_key.key = fsw::kSecondTestKey;
  other_slot.slot = 1;
  EXPECT_FALSE(filter.passes(noop(11, other_key), 16));
  EXPECT_EQ(dropped_by(CommandRefusal::kForged), 1U);
  EXPECT_FALSE(filter.passes(noop(11, other_slot), 16));
  EXPECT_EQ(dropped_by(CommandRefusal::kOtherKey), 1U);
  EXPECT_FALSE(filter.passes(noop(0xFFFFFFFF), 16));
  EXPECT_EQ(dropped_by(CommandRefusal::kOutOfWindow), 1U);
  EXPECT_TRUE(filter.passes(noop(11), 16)) << "nothing that was dropped has spent a counter";
}

TEST_F(CommandFilterTest, FullQueueDropsWithoutSpendingTheCounter) {
  EXPECT_FALSE(filter.passes(noop(11), 0));
  EXPECT_EQ(dropped_by(CommandRefusal::kNoRoom), 1U);
  EXPECT_TRUE(filter.passes(noop(11), 2)) << "the ground may send it again";
}

TEST_F(CommandFilterTest, LastPlacesAreNotForSegmentsOfAModel) {
  const CommandPacket segment =
      fsw::signed_with(fsw::kTestKey, 11,
                       fsw::packet_of(static_cast<std::uint8_t>(FunctionCode::kModelLoad), {0, 0, 0, 0, 1}));
  EXPECT_FALSE(filter.passes(segment, CommandFilter::kReserved));
  EXPECT_EQ(dropped_by(CommandRefusal::kNoRoom), 1U);
  EXPECT_TRUE(filter.passes(segment, CommandFilter::kReserved + 1));
}

constexpr std::uint8_t kSetMode = 3, kSafe = 3;

// Nothing but a whole SET_MODE SAFE takes the last place.
TEST_F(CommandFilterTest, LastPlaceIsForSetModeSafeAlone) {
  constexpr std::size_t kPlace = CommandFilter::kReservedForSafe;
  for (std::uint8_t function = 0; function < 0x80; ++function) {
    for (const std::uint8_t argument : std::vector<std::uint8_t>{0, 1, 2, 4, 255}) {
      const auto other = fsw::signed_with(fsw::kTestKey, 11, fsw::packet_of(function, {argument}));
      EXPECT_FALSE(filter.passes(other, kPlace)) << int{function} << ' ' << int{argument};
    }
  }
  EXPECT_FALSE(
      filter.passes(fsw::signed_with(fsw::kTestKey, 11, fsw::packet_of(kSetMode, {kSafe, 0})), kPlace));
  EXPECT_FALSE(filter.passes(fsw::unsigned_packet(fsw::packet_of(kSetMode, {kSafe})), kPlace)) << "forged";
  const auto safe = fsw::signed_with(fsw::kTestKey, 11, fsw::packet_of(kSetMode, {kSafe}));
  EXPECT_FALSE(filter.passes(safe, 0));
  EXPECT_TRUE(filter.passes(safe, kPlace));
  EXPECT_FALSE(filter.passes(safe, kPlace)) << "a replay";
}

TEST_F(CommandFilterTest, ADamagedSetModeSafeDoesNotTakeItsPlaceOnATrustedLink) {
  CommandFilter trusting;
  const std::vector<std::uint8_t> whole = fsw::packet_of(kSetMode, {kSafe});
  EXPECT_TRUE(trusting.passes(fsw::unsigned_packet(whole), 1));
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::vector<std::uint8_t> damaged = whole;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(trusting.passes(fsw::unsigned_packet(damaged), 1)) << bit;
  }
  CommandPacket longer = fsw::unsigned_packet(whole);
  ++longer.size;
  EXPECT_FALSE(trusting.passes(longer, 1));
  EXPECT_FALSE(trusting.passes(CommandPacket{}, 1));
}

TEST_F(CommandFilterTest, FollowsTheKeySlotAndTheCounterOfTheApplication) {
  filter.follow(0, 20);
  EXPECT_FALSE(filter.passes(noop(20), 16));
  EXPECT_TRUE(filter.passes(noop(22), 16));
  filter.follow(0, 20);
  EXPECT_FALSE(filter.passes(noop(22), 16)) << "it is queued, but the application has not seen it yet";
  fsw::Signature second;
  second.key = fsw::kSecondTestKey;
  second.slot = 1;
  EXPECT_FALSE(filter.passes(noop(23, second), 16));
  filter.follow(1, 22);
  EXPECT_TRUE(filter.passes(noop(23, second), 16));
  EXPECT_FALSE(filter.passes(noop(24), 16)) << "the old key is no longer valid";
}

TEST_F(CommandFilterTest, WithoutKeysTheLinkIsTrusted) {
  CommandFilter trusting;
  EXPECT_TRUE(trusting.passes(fsw::unsigned_packet(fsw::packet_of(1)), 2));
  EXPECT_FALSE(trusting.passes(fsw::unsigned_packet(fsw::packet_of(1)), 0));
}

TEST_F(CommandFilterTest, AnyFlippedBitOfAnyCopyIsOutvoted) {
  std::uint32_t counter = 10;
  for (std::size_t copy = 0; copy < 3; ++copy) {
    for (std::size_t bit = 0; bit < CommandFilterMemory::kBits; ++bit) {
      CommandFilterMemory::flip(filter, copy, bit);
      ASSERT_TRUE(filter.passes(noop(++counter), 16)) << copy << ' ' << bit;
    }
  }
}

}  // namespace
}  // namespace tumblesight::hal
