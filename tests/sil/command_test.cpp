// Telecommands over the whole link. The ground signs them with another implementation than the one that
// checks them.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "gnc/rcnn/model_image.hpp"
#include "tests/sil/sil_test_support.hpp"
#include "tests/support/depacketizer.hpp"

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

// Verifies TS-MDL-020, TS-MDL-030, TS-MDL-040, TS-MDL-050.
TEST_F(Commands, ModelIsLoadedDumpedBackValidatedAndActivatedInFlight) {
  constexpr std::size_t kSegment = 1024, kPerStep = 8;
  const std::vector<std::uint8_t>& image = test::model_bytes();
  StepAnswer answer;
  for (std::size_t offset = 0; offset < image.size();) {
    std::vector<Telecommand> commands;
    for (; commands.size() < kPerStep && offset < image.size(); offset += kSegment) {
      Telecommand load{hal::FunctionCode::kModelLoad, {}};
      append_u32(load.arguments, static_cast<std::uint32_t>(offset));
      const std::size_t size = std::min(kSegment, image.size() - offset);
      load.arguments.insert(load.arguments.end(), image.begin() + static_cast<std::ptrdiff_t>(offset),
                            image.begin() + static_cast<std::ptrdiff_t>(offset + size));
      commands.push_back(load);
    }
    answer = conversation_.step({conversation_.good_frame()}, commands);
    ASSERT_EQ(answer.telemetry.commands_refused, 0U);
  }
  EXPECT_EQ(answer.telemetry.model_bytes_loaded, image.size());

  answer = conversation_.step({}, {{hal::FunctionCode::kModelDump, {1, 0, 0, 0x40, 0, 4, 0}}});
  ASSERT_EQ(answer.dump.size(), kSegment);
  EXPECT_TRUE(std::equal(answer.dump.begin(), answer.dump.end(), image.begin() + 0x4000));

  const std::uint32_t crc32 = gnc::model_image_crc32(image.data());
  Telecommand validate{hal::FunctionCode::kModelValidate, {}},
      activate{hal::FunctionCode::kModelActivate, {}};
  append_u32(validate.arguments, static_cast<std::uint32_t>(image.size()));
  append_u32(validate.arguments, crc32);
  append_u32(activate.arguments, crc32);
  answer =
      conversation_.step({}, {set_mode(hal::Mode::kStandby), validate, activate, set_mode(hal::Mode::kRun)});
  EXPECT_EQ(answer.telemetry.commands_refused, 0U);
  EXPECT_EQ(answer.telemetry.bank_in_use, 1);
  EXPECT_EQ(answer.telemetry.bank_crc32[1], crc32);
  EXPECT_EQ(answer.telemetry.second_copy, 1) << "it is the same image";
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
