// Violates each rule of the command packet alone.
// Verifies TS-CMD-010, TS-CMD-020, TS-SEC-020, TS-SEC-030.
#include "fsw/app/command_gate.hpp"

#include <gtest/gtest.h>

#include "fsw/app/command_table.hpp"
#include "tests/support/make_packet.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint8_t kNoop = static_cast<std::uint8_t>(FunctionCode::kNoop);
constexpr std::uint8_t kSetLimit = static_cast<std::uint8_t>(FunctionCode::kSetLimit);

Admission judged(const std::vector<std::uint8_t>& packet, Mode mode = Mode::kRun) {
  return judge(signed_with(kTestKey, 5, packet), &kTestKey, 4, mode);
}

void expect_refused(const std::vector<std::uint8_t>& packet, CommandRefusal why) {
  const Admission admission = judged(packet);
  EXPECT_FALSE(admission.admitted);
  EXPECT_EQ(admission.why, why) << static_cast<int>(admission.why);
  EXPECT_TRUE(admission.authentic) << "its counter is spent";
}

TEST(CommandGate, AdmitsAGoodPacketWithItsArguments) {
  const Admission admission = judged(packet_of(kSetLimit, {3, 0x01, 0x02, 0x03, 0x04}));
  ASSERT_TRUE(admission.admitted);
  EXPECT_EQ(admission.command.function, FunctionCode::kSetLimit);
  EXPECT_EQ(admission.command.argument_bytes, 5);
  EXPECT_EQ(admission.command.u8_at(0), 3);
  EXPECT_EQ(admission.command.u32_at(1), 0x01020304U);
  EXPECT_EQ(admission.command.u16_at(1), 0x0102U);
  EXPECT_EQ(admission.counter, 5U);
}

TEST(CommandGate, AnyFlippedBitMakesThePacketAForgery) {
  const hal::CommandPacket good = signed_with(kTestKey, 5, packet_of(kSetLimit, {3, 0, 0, 0, 1}));
  for (int bit = 0; bit < 8 * good.size; ++bit) {
    hal::CommandPacket forged = good;
    forged.bytes[static_cast<std::size_t>(bit) / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    const Admission admission = judge(forged, &kTestKey, 4, Mode::kRun);
    ASSERT_FALSE(admission.admitted) << bit;
    ASSERT_EQ(admission.why, CommandRefusal::kForged) << bit;
    ASSERT_FALSE(admission.authentic);
    ASSERT_EQ(admission.function, 0) << "nothing in the packet is trusted";
  }
}

TEST(CommandGate, WrongKeyMissingTrailerOrImpossibleSizeIsAForgery) {
  hal::CommandKey other = kTestKey;
  other[31] ^= 1;
  hal::CommandPacket packet = signed_with(other, 5, packet_of(kNoop));
  EXPECT_EQ(judge(packet, &kTestKey, 4, Mode::kRun).why, CommandRefusal::kForged);
  for (const std::uint16_t size :
       {std::uint16_t{0}, std::uint16_t{19}, std::uint16_t{1061}, std::uint16_t{65535}}) {
    packet.size = size;
    EXPECT_EQ(judge(packet, &kTestKey, 4, Mode::kRun).why, CommandRefusal::kForged) << size;
  }
  EXPECT_EQ(judge(unsigned_packet(packet_of(kNoop)), &kTestKey, 4, Mode::kRun).why, CommandRefusal::kForged);
}

TEST(CommandGate, CounterMustIncrease) {
  const hal::CommandPacket packet = signed_with(kTestKey, 5, packet_of(kNoop));
  EXPECT_TRUE(judge(packet, &kTestKey, 4, Mode::kRun).admitted);
  for (const std::uint32_t last : {5U, 6U, 0xFFFFFFFFU}) {
    const Admission admission = judge(packet, &kTestKey, last, Mode::kRun);
    EXPECT_EQ(admission.why, CommandRefusal::kReplayed);
    EXPECT_FALSE(admission.authentic);
  }
}

TEST(CommandGate, PrimaryHeaderMustBeOfATelecommandToThisApplication) {
  const std::vector<std::uint8_t> good = packet_of(kNoop);
  for (const auto& [offset, value] : {std::pair<std::size_t, int>{0, 0x39},  // version
                                      {0, 0x09},                             // type: telemetry
                                      {0, 0x11},                             // no secondary header
                                      {0, 0x1A},                             // APID, upper bits
                                      {1, 0xF1},                             // APID, lower bits
                                      {2, 0x40},                             // first segment
                                      {7, 0x01}}) {                          // reserved
    std::vector<std::uint8_t> packet = good;
    packet[offset] = static_cast<std::uint8_t>(value);
    set_checksum(packet);
    expect_refused(packet, CommandRefusal::kMalformed);
  }
  expect_refused({good.begin(), good.begin() + 9}, CommandRefusal::kMalformed);
}

TEST(CommandGate, SequenceCountMayBeAny) {
  std::vector<std::uint8_t> packet = packet_of(kNoop);
  packet[2] = 0xFF;
  packet[3] = 0xFF;
  set_checksum(packet);
  EXPECT_TRUE(judged(packet).admitted);
}

TEST(CommandGate, LengthFieldMustMatchThePacket) {
  for (const int by : {-1, 1}) {
    std::vector<std::uint8_t> packet = packet_of(kNoop);
    packet[5] = static_cast<std::uint8_t>(packet[5] + by);
    set_checksum(packet);
    expect_refused(packet, CommandRefusal::kWrongLength);
  }
}

TEST(CommandGate, ChecksumMustMatchThePacket) {
  for (const std::size_t offset : {8U, 9U}) {
    std::vector<std::uint8_t> packet = packet_of(kNoop);
    packet[offset] ^= 1;
    expect_refused(packet, CommandRefusal::kWrongChecksum);
  }
}

// The numbers are part of the interface. They start at 1 and leave no gap: none is removed or used again.
TEST(CommandGate, KnowsEveryFunctionCodeUpToTheLast) {
  constexpr auto kLastOfToday = static_cast<int>(FunctionCode::kDisableResponse);
  static_assert(kNoop == 1 && kSetLimit == 9 && kLastOfToday == 11);
  int last = 0;
  for (int function = 0; function < 256; ++function) {
    const CommandRule* rule = find_command(static_cast<std::uint8_t>(function));
    if (rule == nullptr) continue;
    EXPECT_EQ(function, last + 1);
    EXPECT_EQ(static_cast<int>(rule->function), function);
    last = function;
  }
  EXPECT_GE(last, kLastOfToday);
}

TEST(CommandGate, OnlyTheFunctionsOfTheTableAreKnown) {
  for (int function = 0; function < 256; ++function) {
    const bool known = find_command(static_cast<std::uint8_t>(function)) != nullptr;
    const Admission admission = judged(packet_of(static_cast<std::uint8_t>(function), {0, 0, 0, 0, 0}));
    EXPECT_EQ(!admission.admitted && admission.why == CommandRefusal::kUnknownFunction, !known) << function;
  }
}

TEST(CommandGate, ArgumentLengthAndModeMustMatchTheTable) {
  for (int function = 0; function < 256; ++function) {
    if (find_command(static_cast<std::uint8_t>(function)) == nullptr) continue;
    const CommandRule& rule = *find_command(static_cast<std::uint8_t>(function));
    for (const int bytes : {rule.min_argument_bytes - 1, rule.min_argument_bytes, rule.max_argument_bytes,
                            rule.max_argument_bytes + 1}) {
      if (bytes < 0 ||
          hal::kCommandHeaderBytes + bytes + hal::kCommandTrailerBytes > hal::CommandPacket::kMaxBytes)
        continue;
      const std::vector<std::uint8_t> arguments(static_cast<std::size_t>(bytes), 0);
      const std::vector<std::uint8_t> packet = packet_of(static_cast<std::uint8_t>(rule.function), arguments);
      const bool fits = bytes >= rule.min_argument_bytes && bytes <= rule.max_argument_bytes;
      for (const Mode mode : {Mode::kStandby, Mode::kRun, Mode::kSafe}) {
        const bool allowed = rule.allowed_in(mode);
        const Admission admission = judged(packet, mode);
        EXPECT_EQ(admission.admitted, fits && allowed);
        if (admission.admitted) continue;
        EXPECT_EQ(admission.why, fits ? CommandRefusal::kWrongMode : CommandRefusal::kWrongLength);
      }
    }
  }
}

TEST(CommandGate, WithoutAKeyTheLinkIsTrustedAndThereIsNoTrailer) {
  hal::CommandPacket packet = unsigned_packet(packet_of(kNoop));
  Admission admission = judge(packet, nullptr, 100, Mode::kRun);
  EXPECT_TRUE(admission.admitted);
  EXPECT_FALSE(admission.authentic);
  packet.size = 1061;
  admission = judge(packet, nullptr, 100, Mode::kRun);
  EXPECT_EQ(admission.why, CommandRefusal::kWrongLength);
}

}  // namespace
}  // namespace tumblesight::fsw
