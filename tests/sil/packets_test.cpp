// The packets that flight writes beside what it publishes.
// Verifies TS-TLM-090.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/sil/sil_test_support.hpp"
#include "tests/support/print_message.hpp"

namespace tumblesight::sim {
namespace {

SilSettings settings_with_packets(const std::string& path) {
  SilSettings settings = test::settings();
  settings.flight_arguments = {"--packets", path};
  return settings;
}

// The part of the model bank that the telecommand below asks for.
constexpr std::uint16_t kDumpBytes = 600;
const Telecommand kDump{hal::FunctionCode::kMemoryDump, {0, 0, 0, 0, 16, kDumpBytes >> 8, kDumpBytes & 0xFF}};

hal::MemoryDump dump_of(const StepAnswer& answer) {
  hal::MemoryDump dump;
  dump.time_ns = answer.telemetry.time_ns;
  dump.offset = 16;
  dump.size = kDumpBytes;
  EXPECT_EQ(answer.dump.size(), kDumpBytes);
  std::copy(answer.dump.begin(), answer.dump.end(), dump.bytes.begin());
  return dump;
}

TEST(Packets, DecodedByTheXtceFileTheyAreWhatFlightPublishes) {
  const std::string packets = test::temporary_path("packets.bin");
  const std::string messages = test::temporary_path("messages.json");
  std::ofstream published(messages);
  std::size_t events = 0;
  const auto print = [&](const StepAnswer& answer) {
    tumblesight::test::print(published, answer.attitude);
    tumblesight::test::print(published, answer.telemetry);
    for (const hal::Event& event : answer.events) tumblesight::test::print(published, event);
    if (!answer.dump.empty()) tumblesight::test::print(published, dump_of(answer));
    events += answer.events.size();
  };
  test::Conversation conversation(settings_with_packets(packets));
  print(conversation.step());
  print(conversation.step({conversation.good_frame()}, {kDump}));
  print(conversation.step({}));  // a missing frame
  print(conversation.step({conversation.good_frame()}, {set_mode(hal::Mode::kStandby)}));
  print(conversation.step({conversation.good_frame()}, {set_mode(hal::Mode::kRun)}));
  for (int i = 0; i < 5; ++i) print(conversation.step());
  print(conversation.finish());
  published.close();
  EXPECT_GT(events, 3U);
  EXPECT_EQ(std::system((TUMBLESIGHT_COMPARE_PACKETS " " + packets + " " + messages).c_str()), 0)
      << test::read_file(messages);
}

TEST(Packets, FileThatCannotBeCreatedIsRefusedAtTheStart) {
  const SilSettings settings = settings_with_packets("/no/such/folder/packets.bin");
  EXPECT_THROW(test::Conversation{settings}, SilFailure);
  const std::string log = test::read_file(settings.flight_log_path);
  EXPECT_NE(log.find("--packets /no/such/folder/packets.bin: No such file"), std::string::npos) << log;
}

TEST(Packets, PacketsThatCannotBeWrittenAreReported) {
  const SilSettings settings = settings_with_packets("/dev/full");
  test::Conversation conversation(settings);
  conversation.step();
  EXPECT_THROW(
      {
        conversation.step({conversation.good_frame()}, {}, true);
        conversation.session.finish();
      },
      SilFailure);
  const std::string log = test::read_file(settings.flight_log_path);
  EXPECT_NE(log.find("packets could not be written to /dev/full: No space left"), std::string::npos) << log;
  EXPECT_EQ(log.find("DDS"), std::string::npos) << log;
}

}  // namespace
}  // namespace tumblesight::sim
