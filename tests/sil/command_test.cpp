// Telecommands over the whole link. The ground signs them with another implementation than the one that
// checks them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "sim/operations/model_upload.hpp"
#include "tests/sil/sil_test_support.hpp"
#include "tests/support/depacketizer.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim {
namespace {

constexpr auto kForged = static_cast<std::size_t>(hal::CommandRefusal::kForged);
constexpr auto kReplayed = static_cast<std::size_t>(hal::CommandRefusal::kReplayed);

void append_u32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

class Commands : public ::testing::Test {
 protected:
  StepAnswer step_packets(const std::vector<hal::CommandPacket>& packets) {
    StepInput input;
    const gnc::RangeImage frame = conversation_.good_frame();
    input.time_ns = test::Conversation::time_ns(conversation_.k++);
    input.frames = {&frame};
    input.packets = packets;
    return conversation_.session.step(input);
  }
  test::Conversation conversation_{test::settings()};
};

// Verifies TS-SEC-020, TS-SEC-030.
TEST_F(Commands, ForgedAndReplayedCommandsAreRefusedAndCounted) {
  SilSettings settings = test::settings();
  TelecommandEncoder ground(settings.command_key);
  const hal::CommandPacket noop = ground.packet({hal::FunctionCode::kNoop, {}});
  hal::CommandPacket spoilt = ground.packet({hal::FunctionCode::kNoop, {}});
  spoilt.bytes[6] = static_cast<std::uint8_t>(hal::FunctionCode::kResetCounters);
  settings.command_key[0] ^= 1;
  const hal::CommandPacket stranger =
      TelecommandEncoder(settings.command_key).packet(set_mode(hal::Mode::kSafe));
  const StepAnswer answer = step_packets({noop, noop, spoilt, stranger});
  EXPECT_EQ(answer.telemetry.commands_accepted, 1U);
  EXPECT_EQ(answer.telemetry.commands_refused_by[kReplayed], 1U);
  EXPECT_EQ(answer.telemetry.commands_refused_by[kForged], 2U);
  EXPECT_EQ(answer.telemetry.mode, hal::Mode::kRun);
  EXPECT_TRUE(gives_attitude(answer.attitude));
  conversation_.finish();
}

// Verifies TS-CMD-160.
TEST(GroundPackets, StandardReceiverGetsThemOutOfAStream) {
  TelecommandEncoder ground(test::settings().command_key);
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < 5; ++i) {
    const hal::CommandPacket packet =
        ground.packet({hal::FunctionCode::kModelLoad,
                       std::vector<std::uint8_t>(static_cast<std::size_t>(5 + 200 * i), 0xC3)});
    stream.insert(stream.end(), packet.bytes.begin(), packet.bytes.begin() + packet.size);
  }
  const std::vector<standard::SpacePacket> received = standard::depacketize(stream);
  ASSERT_EQ(received.size(), 5U);
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < received.size(); ++i) {
    bytes += received[i].whole.size();
    EXPECT_EQ(received[i].sequence_count, static_cast<int>(i));
    EXPECT_EQ(received[i].cfs_function(), 5);
    EXPECT_TRUE(received[i].cfs_checksum_is_valid());
  }
  EXPECT_EQ(bytes, stream.size()) << "nothing lies between two packets";
}

// Verifies TS-RST-010, TS-RST-020, TS-SEC-030.
TEST(StoredState, OutlivesTheFlightProgram) {
  SilSettings settings = test::settings();
  const std::string path = test::temporary_path("state");
  settings.flight_arguments = {"--state", path};
  TelecommandEncoder ground(settings.command_key);
  const hal::CommandPacket safe = ground.packet(set_mode(hal::Mode::kSafe));
  const auto answer_to = [&settings](const std::vector<hal::CommandPacket>& packets) {
    test::Conversation conversation(settings);
    StepInput input;
    input.time_ns = test::Conversation::time_ns(conversation.k++);
    input.packets = packets;
    const StepAnswer answer = conversation.session.step(input);
    conversation.finish();
    return answer.telemetry;
  };
  EXPECT_EQ(answer_to({safe}).mode, hal::Mode::kSafe);
  settings.flight_arguments = {"--state", path, "--reset", "watchdog"};
  const hal::Telemetry telemetry = answer_to({safe});
  const std::string log = test::read_file(settings.flight_log_path);
  EXPECT_NE(log.find("the mode is SAFE; send SET_MODE STANDBY, then SET_MODE RUN, or delete " + path),
            std::string::npos)
      << log;
  EXPECT_EQ(telemetry.mode, hal::Mode::kSafe);
  EXPECT_EQ(telemetry.safe_cause, hal::Cause::kCommandSafe);
  EXPECT_EQ(telemetry.commands_refused_by[kReplayed], 1U);
  const hal::Telemetry after = answer_to({ground.packet(set_mode(hal::Mode::kStandby))});
  EXPECT_EQ(after.mode, hal::Mode::kStandby);
  EXPECT_EQ(after.command_counter, 2U);
}

// Verifies TS-SIL-110.
TEST(StoredState, ALaterRunCarriesOnWithItsCounter) {
  SilSettings settings = test::settings();
  settings.flight_arguments = {"--state", test::temporary_path("state")};
  for (std::uint32_t runs = 1; runs <= 3; ++runs) {
    const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(2, 3), {});
    EXPECT_EQ(run.failure, "");
    const hal::Telemetry& telemetry = run.steps.back().telemetry;
    EXPECT_EQ(telemetry.commands_accepted, 2U) << "RESET_SEQUENCE, once per sequence";
    EXPECT_EQ(telemetry.commands_refused, 0U);
    EXPECT_EQ(telemetry.command_counter, 2 * runs);
  }
}

// Verifies TS-SIL-040.
TEST(StoredState, OfSafeEndsARunWithTheReason) {
  SilSettings settings = test::settings();
  settings.flight_arguments = {"--state", test::temporary_path("state")};
  {
    test::Conversation conversation(settings);
    conversation.step({}, {set_mode(hal::Mode::kSafe)});
    conversation.finish();
  }
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 3), {});
  EXPECT_NE(run.failure.find("is in SAFE mode: its file of --state says so"), std::string::npos)
      << run.failure;
  settings.flight_arguments = {"--state", test::temporary_path("another"), "--model", "/nonexistent"};
  const SilRunResult other = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 3), {});
  EXPECT_NE(other.failure.find("is in SAFE mode: it has no usable model image"), std::string::npos)
      << other.failure;
}

// Verifies TS-MODE-040, TS-MODE-050.
TEST_F(Commands, ModesFollowTheCommands) {
  EXPECT_EQ(conversation_.step({conversation_.good_frame()}, {set_mode(hal::Mode::kSafe)}).telemetry.mode,
            hal::Mode::kSafe);
  EXPECT_EQ(conversation_.step({conversation_.good_frame()}, {set_mode(hal::Mode::kRun)}).telemetry.mode,
            hal::Mode::kSafe);
  const StepAnswer answer = conversation_.step({conversation_.good_frame()},
                                               {set_mode(hal::Mode::kStandby), set_mode(hal::Mode::kRun)});
  EXPECT_EQ(answer.telemetry.mode, hal::Mode::kRun);
  EXPECT_EQ(answer.attitude.frames_since_reset, 1U);
  conversation_.finish();
}

class Upload : public Commands {
 protected:
  // Sends segments, eight per step, except every `lost`-th one; 0: none is lost.
  StepAnswer send(const ModelUpload& upload, const std::vector<std::uint32_t>& segments,
                  std::size_t lost = 0) {
    StepAnswer answer;
    std::vector<Telecommand> commands;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (lost == 0 || i % lost != lost - 1) commands.push_back(upload.segment(segments[i]));
      if (commands.size() < 8 && i + 1 < segments.size()) continue;
      answer = conversation_.step({conversation_.good_frame()}, commands);
      EXPECT_EQ(answer.telemetry.commands_refused, 0U);
      EXPECT_TRUE(gives_attitude(answer.attitude));
      commands.clear();
    }
    return answer;
  }
  std::vector<std::uint32_t> missing(const ModelUpload& upload) {
    const StepAnswer answer = conversation_.step({conversation_.good_frame()}, {upload.missing_request()});
    std::vector<std::uint32_t> segments = upload.missing(answer.dump);
    EXPECT_GE(segments.size(), answer.telemetry.model_segments_missing) << "the copy goes on after the dump";
    return segments;
  }
  // The image in the bank is `image`, it is activated, and it runs.
  void expect_it_runs(const ModelUpload& upload, const std::vector<std::uint8_t>& image, std::uint8_t bank) {
    constexpr std::uint32_t kPart = 1024;
    for (std::uint32_t offset = 0; offset < image.size(); offset += 97 * kPart) {
      Telecommand dump{hal::FunctionCode::kMemoryDump, {bank}};
      append_u32(dump.arguments, offset);
      const auto size = std::min<std::size_t>(kPart, image.size() - offset);
      dump.arguments.insert(dump.arguments.end(),
                            {static_cast<std::uint8_t>(size >> 8), static_cast<std::uint8_t>(size)});
      const StepAnswer answer = conversation_.step({}, {dump});
      ASSERT_EQ(answer.dump.size(), size);
      EXPECT_TRUE(std::equal(answer.dump.begin(), answer.dump.end(), image.begin() + offset)) << offset;
    }
    conversation_.step({}, {set_mode(hal::Mode::kStandby), upload.validate()});
    StepAnswer answer = conversation_.step({}, {upload.activate(), set_mode(hal::Mode::kRun)});
    EXPECT_EQ(answer.telemetry.commands_refused, 0U);
    EXPECT_EQ(answer.telemetry.bank_in_use, bank);
    EXPECT_EQ(answer.telemetry.bank_crc32[bank], upload.crc32());
    answer = conversation_.step();
    EXPECT_TRUE(gives_attitude(answer.attitude));
  }
};

// Verifies TS-MDL-020, TS-MDL-030, TS-MDL-040, TS-MDL-050, TS-MDL-070.
TEST_F(Upload, WithEveryThirdSegmentLostIsCompletedByTheMissingOnesAndRuns) {
  const ModelUpload upload(test::model_bytes());
  conversation_.step({}, {upload.begin()});
  send(upload, upload.to_send(), 3);
  const std::vector<std::uint32_t> lost = missing(upload);
  EXPECT_EQ(lost.size(), upload.to_send().size() / 3);
  send(upload, lost, 10);
  send(upload, missing(upload));
  EXPECT_TRUE(missing(upload).empty());
  expect_it_runs(upload, test::model_bytes(), 1);
  conversation_.finish();
}

// Verifies TS-MDL-080.
TEST_F(Upload, OfTheDifferencesGivesTheSameImageAsAFullOne) {
  const std::vector<std::uint8_t>& first = test::model_bytes();
  const std::vector<std::uint8_t> second = gnc::with_changed_weights(first, {300'000, 700'123});
  const ModelUpload there(second, first), back(first, second);
  EXPECT_LE(there.to_send().size(), 4U) << "two weights and the header with its CRCs";
  conversation_.step({}, {there.begin()});
  send(there, there.to_send());
  while (!missing(there).empty()) {
  }
  expect_it_runs(there, second, 1);
  conversation_.step({}, {back.begin()});
  send(back, back.to_send());
  while (!missing(back).empty()) {
  }
  expect_it_runs(back, first, 0);
  conversation_.finish();
}

// Verifies TS-SEC-040.
TEST(CommandKey, FromAFileReplacesTheDevelopmentKey) {
  SilSettings settings = test::settings();
  const std::string path = test::temporary_path("command.key");
  std::ofstream(path) << std::string(64, 'a') << '\n';
  settings.flight_arguments = {"--command-key", path};
  {
    test::Conversation conversation(settings);
    const StepAnswer answer = conversation.step({conversation.good_frame()}, {reset_sequence()});
    EXPECT_EQ(answer.telemetry.commands_refused_by[kForged], 1U);
    conversation.finish();
  }
  settings.command_key.fill(0xAA);
  test::Conversation conversation(settings);
  const StepAnswer answer = conversation.step({conversation.good_frame()}, {reset_sequence()});
  EXPECT_EQ(answer.telemetry.commands_accepted, 1U);
  conversation.finish();
}

// Verifies TS-SEC-090.
TEST(CommandKey, TheDevelopmentKeyIsNotedOnce) {
  const std::string note = "signed with the public development key";
  SilSettings settings = test::settings();
  test::Conversation(settings).finish();
  const std::string log = test::read_file(settings.flight_log_path);
  EXPECT_NE(log.find(note), std::string::npos) << log;
  EXPECT_EQ(log.find(note), log.rfind(note)) << log;
  settings = test::settings();
  const std::string path = test::temporary_path("command.key");
  std::ofstream(path) << std::string(64, 'a') << '\n';
  settings.flight_arguments = {"--command-key", path};
  settings.command_key.fill(0xAA);
  test::Conversation(settings).finish();
  EXPECT_EQ(test::read_file(settings.flight_log_path).find(note), std::string::npos);
}

// Verifies TS-SEC-040.
TEST(CommandKey, InvalidFileEndsFlightWithTheReason) {
  for (const std::string& content :
       {std::string(63, 'a'), std::string(65, 'a'), std::string(64, 'g'), std::string()}) {
    SilSettings settings = test::settings();
    const std::string path = test::temporary_path("command.key");
    std::ofstream(path) << content;
    settings.flight_arguments = {"--command-key", path};
    EXPECT_THROW(SilSession{settings}, SilFailure);
    EXPECT_NE(test::read_file(settings.flight_log_path).find("64 hexadecimal digits"), std::string::npos);
  }
  SilSettings settings = test::settings();
  settings.flight_arguments = {"--command-key", "/nonexistent/key"};
  EXPECT_THROW(SilSession{settings}, SilFailure);
  EXPECT_NE(test::read_file(settings.flight_log_path).find("/nonexistent/key"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
