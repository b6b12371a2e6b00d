// Violates each rule of the command packet alone.
// Verifies TS-CMD-010, TS-CMD-020, TS-SEC-020, TS-SEC-030.
#include "fsw/app/command_gate.hpp"

#include <gtest/gtest.h>

#include "fsw/app/command_table.hpp"
#include "tests/support/make_packet.hpp"

namespace tumblesight::fsw {
namespace {

constexpr std::uint8_t kNoop = static_cast<std::uint8_t>(FunctionCode::kNoop);
constexpr std::uint8_t kSetParameter = static_cast<std::uint8_t>(FunctionCode::kSetParameter);

CommandAuthority test_authority() {
  CommandAuthority authority;
  authority.set(&kTestKeys);
  return authority;
}

Admission judge_in_run(const hal::CommandPacket& packet, std::uint32_t last_counter = 4) {
  return judge(packet, test_authority(), last_counter, Mode::kRun);
}

Admission judged(const std::vector<std::uint8_t>& packet, Mode mode = Mode::kRun) {
  return judge(signed_with(kTestKey, 5, packet), test_authority(), 4, mode);
}

void expect_refused(const std::vector<std::uint8_t>& packet, CommandRefusal why) {
  const Admission admission = judged(packet);
  EXPECT_FALSE(admission.admitted);
  EXPECT_EQ(admission.why, why) << static_cast<int>(admission.why);
  EXPECT_TRUE(admission.authentic) << "its counter is spent";
}

TEST(CommandGate, AdmitsAGoodPacketWithItsArguments) {
  const Admission admission = judged(packet_of(kSetParameter, {3, 0x01, 0x02, 0x03, 0x04}));
  ASSERT_TRUE(admission.admitted);
  EXPECT_EQ(admission.command.function, FunctionCode::kSetParameter);
  EXPECT_EQ(admission.command.argument_bytes, 5);
  EXPECT_EQ(admission.command.u8_at(0), 3);
  EXPECT_EQ(admission.command.u32_at(1), 0x01020304U);
  EXPECT_EQ(admission.command.u16_at(1), 0x0102U);
  EXPECT_EQ(admission.counter, 5U);
}

TEST(CommandGate, AnyFlippedBitMakesThePacketUseless) {
  const hal::CommandPacket good = signed_with(kTestKey, 5, packet_of(kSetParameter, {3, 0, 0, 0, 1}));
  const int key_slot = good.size - 22;
  for (int bit = 0; bit < 8 * good.size; ++bit) {
    hal::CommandPacket forged = good;
    forged.bytes[static_cast<std::size_t>(bit) / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    const Admission admission = judge_in_run(forged);
    ASSERT_FALSE(admission.admitted) << bit;
    if (bit / 8 == hal::kCommandChecksumOffset) {
      ASSERT_EQ(admission.why, CommandRefusal::kWrongChecksum) << "the only byte that the code leaves out";
      continue;
    }
    ASSERT_EQ(admission.why, bit / 8 == key_slot ? CommandRefusal::kOtherKey : CommandRefusal::kForged)
        << bit;
    ASSERT_FALSE(admission.authentic);
    ASSERT_EQ(admission.function, 0) << "nothing in the packet is trusted";
  }
}

TEST(CommandGate, WrongKeyMissingTrailerOrImpossibleSizeIsAForgery) {
  hal::CommandKey other = kTestKey;
  other[31] ^= 1;
  hal::CommandPacket packet = signed_with(other, 5, packet_of(kNoop));
  EXPECT_EQ(judge_in_run(packet).why, CommandRefusal::kForged);
  for (const std::uint16_t size :
       {std::uint16_t{0}, std::uint16_t{31}, std::uint16_t{1061}, std::uint16_t{65535}}) {
    packet.size = size;
    EXPECT_EQ(judge_in_run(packet).why, CommandRefusal::kForged) << size;
  }
  EXPECT_EQ(judge_in_run(unsigned_packet(packet_of(kNoop))).why, CommandRefusal::kForged);
}

TEST(CommandGate, CounterMustIncrease) {
  const hal::CommandPacket packet = signed_with(kTestKey, 5, packet_of(kNoop));
  EXPECT_TRUE(judge_in_run(packet, 4).admitted);
  for (const std::uint32_t last : {5U, 6U, 0xFFFFFFFFU}) {
    const Admission admission = judge_in_run(packet, last);
    EXPECT_EQ(admission.why, CommandRefusal::kReplayed);
    EXPECT_FALSE(admission.authentic);
  }
}

// Verifies TS-SEC-050.
TEST(CommandGate, CounterFarAheadIsOutOfTheWindowAndNotSpent) {
  for (const std::uint32_t last : {0U, 4U, 0xFFFE'0000U, 0xFFFF'0000U}) {
    const std::uint64_t farthest = std::uint64_t{last} + hal::kCommandWindow;
    for (const std::uint64_t counter : {farthest, farthest + 1, std::uint64_t{0xFFFFFFFF}}) {
      if (counter > 0xFFFFFFFF) continue;
      const bool inside = counter <= farthest;
      const Admission admission =
          judge_in_run(signed_with(kTestKey, static_cast<std::uint32_t>(counter), packet_of(kNoop)), last);
      EXPECT_EQ(admission.admitted, inside) << last << ' ' << counter;
      EXPECT_EQ(admission.authentic, inside);
      if (!inside) {
        EXPECT_EQ(admission.why, CommandRefusal::kOutOfWindow);
      }
    }
  }
}

// Verifies TS-SEC-060.
TEST(CommandGate, KeySlotAndSpacecraftMustBeThoseOfThisApplication) {
  Signature second;
  second.key = kSecondTestKey;
  second.slot = 1;
  EXPECT_EQ(judge_in_run(signed_as(second, 5, packet_of(kNoop))).why, CommandRefusal::kOtherKey);
  CommandAuthority authority = test_authority();
  ASSERT_TRUE(authority.use(1));
  EXPECT_TRUE(judge(signed_as(second, 5, packet_of(kNoop)), authority, 4, Mode::kRun).admitted);
  EXPECT_EQ(judge(signed_with(kTestKey, 5, packet_of(kNoop)), authority, 4, Mode::kRun).why,
            CommandRefusal::kOtherKey);
  Signature other_craft;
  other_craft.spacecraft_id ^= 1;
  const Admission admission = judge_in_run(signed_as(other_craft, 5, packet_of(kNoop)));
  EXPECT_EQ(admission.why, CommandRefusal::kOtherSpacecraft);
  EXPECT_FALSE(admission.authentic) << "its counter is not spent";
}

TEST(CommandGate, ApidMustBeThatOfThePlatform) {
  CommandAuthority authority;
  for (const std::uint16_t apid : {hal::kCommandApid, std::uint16_t{0x000}, std::uint16_t{0x7FE}}) {
    authority.set(&kTestKeys, apid);
    std::vector<std::uint8_t> packet = packet_of(kNoop);
    packet[0] = static_cast<std::uint8_t>(0x18 | apid >> 8);
    packet[1] = static_cast<std::uint8_t>(apid & 0xFF);
    set_checksum(packet);
    EXPECT_TRUE(judge(signed_with(kTestKey, 5, packet), authority, 4, Mode::kRun).admitted) << apid;
    packet[1] ^= 1;
    set_checksum(packet);
    EXPECT_EQ(judge(signed_with(kTestKey, 5, packet), authority, 4, Mode::kRun).why,
              CommandRefusal::kMalformed);
  }
}

TEST(CommandGate, EmptyOrUnknownKeySlotAuthenticatesNothing) {
  CommandAuthority authority = test_authority();
  EXPECT_FALSE(authority.use(2));
  EXPECT_FALSE(authority.use(hal::kCommandKeySlots));
  EXPECT_EQ(authority.slot(), 0U);
  CommandAuthority without;
  EXPECT_FALSE(without.use(0));
  const hal::CommandKeys none{};
  without.set(&none);
  Signature zeros;
  zeros.key = {};
  zeros.spacecraft_id = 0;
  EXPECT_EQ(judge(signed_as(zeros, 5, packet_of(kNoop)), without, 4, Mode::kRun).why, CommandRefusal::kForged)
      << "a key of zeros is no key";
}

TEST(CommandGate, ReservedByteOfTheTrailerMustBeZero) {
  Signature signature;
  signature.reserved = 1;
  const Admission admission = judge_in_run(signed_as(signature, 5, packet_of(kNoop)));
  EXPECT_EQ(admission.why, CommandRefusal::kMalformed);
  EXPECT_FALSE(admission.admitted);
  EXPECT_TRUE(admission.authentic) << "its counter is spent";
}

TEST(CommandGate, PrimaryHeaderMustBeOfATelecommandToThisApplication) {
  const std::vector<std::uint8_t> good = packet_of(kNoop);
  for (const auto& [offset, value] : {std::pair<std::size_t, int>{0, 0x39},  // version
                                      {0, 0x09},                             // type: telemetry
                                      {0, 0x11},                             // no secondary header
                                      {0, 0x1A},                             // APID, upper bits
                                      {1, 0xF1},                             // APID, lower bits
                                      {2, 0x40},                             // first segment
                                      {6, 0x81}}) {                          // reserved bit
    std::vector<std::uint8_t> packet = good;
    packet[offset] = static_cast<std::uint8_t>(value);
    set_checksum(packet);
    expect_refused(packet, CommandRefusal::kMalformed);
  }
  const hal::CommandPacket cut = unsigned_packet({good.begin(), good.begin() + 7});
  EXPECT_EQ(judge(cut, CommandAuthority{}, 0, Mode::kRun).why, CommandRefusal::kMalformed);
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
  for (int bit = 0; bit < 8; ++bit) {
    std::vector<std::uint8_t> packet = packet_of(kNoop);
    packet[7] ^= static_cast<std::uint8_t>(1 << bit);
    expect_refused(packet, CommandRefusal::kWrongChecksum);
  }
}

// The numbers are part of the interface. They start at 1 and leave no gap: none is removed or used again.
TEST(CommandGate, KnowsEveryFunctionCodeUpToTheLast) {
  constexpr auto kLastOfToday = static_cast<int>(FunctionCode::kDisableResponse);
  static_assert(kNoop == 1 && kSetParameter == 9 && kLastOfToday == 11);
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
    if (function > 127) {
      EXPECT_EQ(admission.why, CommandRefusal::kMalformed) << "a function code has 7 bits";
      continue;
    }
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
  Admission admission = judge(packet, CommandAuthority{}, 100, Mode::kRun);
  EXPECT_TRUE(admission.admitted);
  EXPECT_FALSE(admission.authentic);
  packet.size = 1061;
  admission = judge(packet, CommandAuthority{}, 100, Mode::kRun);
  EXPECT_EQ(admission.why, CommandRefusal::kWrongLength);
}

}  // namespace
}  // namespace tumblesight::fsw
