// Verifies TS-TLM-070.
#include "hal/packets/telemetry_encoder.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

#include "gnc/numerics/crc.hpp"

namespace tumblesight::hal::packets {
namespace {

std::string hex(const TelemetryPacket& packet) {
  std::string text;
  for (std::size_t i = 0; i < packet.size; ++i) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    text += kDigits[packet.bytes[i] >> 4];
    text += kDigits[packet.bytes[i] & 15];
  }
  return text;
}

std::uint64_t big_endian(const TelemetryPacket& packet, std::size_t offset, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | packet.bytes[offset + i];
  return value;
}

std::uint16_t apid_of(const TelemetryPacket& packet) {
  return static_cast<std::uint16_t>(big_endian(packet, 0, 2) & 0x7FF);
}

std::uint16_t count_of(const TelemetryPacket& packet) {
  return static_cast<std::uint16_t>(big_endian(packet, 2, 2) & 0x3FFF);
}

std::uint64_t cuc_at(std::int64_t time_ns) {
  TelemetryEncoder encoder;
  Event event;
  event.time_ns = time_ns;
  return big_endian(encoder.encode(event), 6, 8);
}

// The bytes come from Python's struct.pack() and binascii.crc_hqx(), by docs/icd.md.
TEST(TelemetryEncoder, WritesAnEventByteForByte) {
  Event event;
  event.time_ns = 2'700'000'001;
  event.id = EventId::kEstimatorResetByGap;
  event.severity = Severity::kWarning;
  event.arguments = {-2700, std::numeric_limits<std::int32_t>::max(),
                     std::numeric_limits<std::int32_t>::min()};
  EXPECT_EQ(hex(TelemetryEncoder().encode(event)),
            "09F3C000002000000002B333333700000000A0EEBB01002801FFFFF5747FFFFFFF8000000069D8");
}

// All packets: the header's table in the interface document, the message's size, the CRC.
template <class Message>
void expect_sound(std::uint16_t apid) {
  TelemetryEncoder encoder;
  Message message;
  message.time_ns = 5'400'000'000;
  const TelemetryPacket& packet = encoder.encode(message);
  ASSERT_EQ(packet.size, packet_bytes<Message>());
  EXPECT_EQ(big_endian(packet, 0, 2), 0x0800U | apid);
  EXPECT_EQ(big_endian(packet, 2, 2), 0xC000U);
  EXPECT_EQ(big_endian(packet, 4, 2), packet.size - 7U);
  EXPECT_EQ(big_endian(packet, 6, 4), 5U);
  EXPECT_EQ(big_endian(packet, 10, 4), 0x66666666U);
  EXPECT_EQ(big_endian(packet, 14, 8), 5'400'000'000U);
  EXPECT_EQ(gnc::crc16(packet.bytes.data(), packet.size), 0U);
}

TEST(TelemetryEncoder, AllPacketsHaveHeaderTimeAndErrorControl) {
  expect_sound<AttitudeReport>(0x1F1);
  expect_sound<Telemetry>(0x1F2);
  expect_sound<Event>(0x1F3);
  expect_sound<MemoryDump>(0x1F4);
}

TEST(TelemetryEncoder, CountsEachApidByItselfModulo16384) {
  TelemetryEncoder encoder;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(count_of(encoder.encode(Telemetry{})), i);
  EXPECT_EQ(count_of(encoder.encode(AttitudeReport{})), 0);
  EXPECT_EQ(count_of(encoder.encode(MemoryDump{})), 0);
  for (int i = 0; i < 16'384; ++i) EXPECT_EQ(count_of(encoder.encode(Event{})), i);
  EXPECT_EQ(count_of(encoder.encode(Event{})), 0);
  EXPECT_EQ(count_of(encoder.encode(Telemetry{})), 3);
}

TEST(TelemetryEncoder, UsesTheApidsOfTheMission) {
  TelemetryEncoder encoder({0, kMaxApid, 0x123, 0x400});
  EXPECT_EQ(apid_of(encoder.encode(AttitudeReport{})), 0);
  EXPECT_EQ(apid_of(encoder.encode(Telemetry{})), kMaxApid);
  EXPECT_EQ(apid_of(encoder.encode(Event{})), 0x123);
  EXPECT_EQ(apid_of(encoder.encode(MemoryDump{})), 0x400);
}

TEST(TelemetryEncoder, ApidsMustDifferAndMustNotBeThatOfIdlePackets) {
  EXPECT_TRUE(are_valid(PacketApids{}));
  EXPECT_TRUE(are_valid({0, 1, 2, kMaxApid}));
  EXPECT_FALSE(are_valid({0x7FF, 1, 2, 3}));
  EXPECT_FALSE(are_valid({0, 1, 2, 0x800}));
  EXPECT_FALSE(are_valid({5, 5, 2, 3}));
  EXPECT_FALSE(are_valid({5, 1, 2, 5}));
  EXPECT_FALSE(are_valid({0, 1, 3, 3}));
}

TEST(TelemetryEncoder, TimeIsRoundedToTheNearestFraction) {
  EXPECT_EQ(cuc_at(0), 0U);
  EXPECT_EQ(cuc_at(1), 4U);  // 4.29
  EXPECT_EQ(cuc_at(2), 9U);  // 8.59
  EXPECT_EQ(cuc_at(500'000'000), 0x8000'0000U);
  EXPECT_EQ(cuc_at(999'999'999), 0xFFFF'FFFCU);  // 2^32 - 4.29
  EXPECT_EQ(cuc_at(1'000'000'000), std::uint64_t{1} << 32);
}

TEST(TelemetryEncoder, TimeGivesBackTheNanoseconds) {
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const std::int64_t time_ns = std::int64_t{i} * 9'999'991 + 3;
    const std::uint64_t cuc = cuc_at(time_ns);
    const std::uint64_t fraction_ns = ((cuc & 0xFFFF'FFFFU) * 1'000'000'000 + (std::uint64_t{1} << 31)) >> 32;
    ASSERT_EQ((cuc >> 32) * 1'000'000'000 + fraction_ns, static_cast<std::uint64_t>(time_ns));
  }
}

TEST(TelemetryEncoder, TimesThatCucCannotShowAreClampedAndKeptInTheMessage) {
  constexpr std::int64_t kLast_ns = (std::int64_t{1} << 32) * 1'000'000'000 - 1;
  EXPECT_EQ(cuc_at(-1), 0U);
  EXPECT_EQ(cuc_at(std::numeric_limits<std::int64_t>::min()), 0U);
  EXPECT_EQ(cuc_at(kLast_ns), 0xFFFF'FFFF'FFFF'FFFCU);
  EXPECT_EQ(cuc_at(kLast_ns + 1), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(cuc_at(std::numeric_limits<std::int64_t>::max()), std::numeric_limits<std::uint64_t>::max());
  TelemetryEncoder encoder;
  Event event;
  event.time_ns = -1;
  EXPECT_EQ(big_endian(encoder.encode(event), 14, 8), std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace tumblesight::hal::packets
