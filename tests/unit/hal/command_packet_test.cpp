// A receiver that knows only the standard gets whole telecommands out of a stream of several.
// Verifies TS-CMD-160.
#include "hal/messages/command_packet.hpp"

#include <gtest/gtest.h>

#include "hal/command_authentication.hpp"
#include "tests/support/depacketizer.hpp"
#include "tests/support/make_packet.hpp"

namespace tumblesight::hal {
namespace {

void append(std::vector<std::uint8_t>& stream, const CommandPacket& packet) {
  stream.insert(stream.end(), packet.bytes.begin(), packet.bytes.begin() + packet.size);
}

TEST(CommandPacket, StandardReceiverGetsWholePacketsOutOfAStream) {
  std::vector<CommandPacket> sent;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const std::size_t arguments = i == 7 ? kMaxCommandArgumentBytes : 3 * i;
    sent.push_back(fsw::signed_with(fsw::kTestKey, i + 1,
                                    fsw::packet_of(5, std::vector<std::uint8_t>(arguments, 0xC3))));
  }
  std::vector<std::uint8_t> stream;
  for (const CommandPacket& packet : sent) append(stream, packet);

  const std::vector<standard::SpacePacket> received = standard::depacketize(stream);
  ASSERT_EQ(received.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const standard::SpacePacket& packet = received[i];
    EXPECT_EQ(packet.whole,
              std::vector<std::uint8_t>(sent[i].bytes.begin(), sent[i].bytes.begin() + sent[i].size));
    EXPECT_EQ(packet.version, 0);
    EXPECT_EQ(packet.type, 1);
    EXPECT_EQ(packet.secondary_header, 1);
    EXPECT_EQ(packet.apid, 0x1F0);
    EXPECT_EQ(packet.sequence_flags, 3);
    EXPECT_EQ(packet.cfs_reserved(), 0);
    EXPECT_EQ(packet.cfs_function(), 5);
    EXPECT_TRUE(packet.cfs_checksum_is_valid());
    CommandPacket again = fsw::unsigned_packet(packet.whole);
    EXPECT_TRUE(origin_of(again, fsw::kTestKeys, 0, static_cast<std::uint32_t>(i)).authentic)
        << "the trailer came through";
  }
}

TEST(CommandPacket, PacketWithoutATrailerIsAPlainCfsCommand) {
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < 3; ++i) append(stream, fsw::unsigned_packet(fsw::packet_of(3, {2})));
  const std::vector<standard::SpacePacket> received = standard::depacketize(stream);
  ASSERT_EQ(received.size(), 3U);
  EXPECT_EQ(received[2].data_field.size(), 3U);
  EXPECT_TRUE(received[2].cfs_checksum_is_valid());
}

}  // namespace
}  // namespace tumblesight::hal
