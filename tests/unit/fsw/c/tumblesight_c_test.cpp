// The application through its C interface. That its results are those of C++ is shown with recorded frames:
// Replay.SmallestProgramInCHasTheGoldenDigest.
#include "fsw/c/tumblesight_c.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "fsw/app/parameter_table.hpp"
#include "fsw/config/limits.hpp"
#include "hal/messages/command_refusal.hpp"
#include "hal/messages/event_id.hpp"
#include "hal/messages/fault.hpp"
#include "hal/messages/function_code.hpp"
#include "hal/messages/mode.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

// A store as a board would have it.
struct Board {
  std::map<int, std::vector<std::uint8_t>> stored;
  tumblesight_store_status read_status = TUMBLESIGHT_STORE_OK;
  bool fails_to_write = false;
  std::uint64_t time_ns = 0;

  std::uint64_t tick_ns = 1'000'000;

  static std::uint64_t now_ns(void* context) {
    auto& board = *static_cast<Board*>(context);
    return board.time_ns += board.tick_ns;
  }
  static tumblesight_store_status read(void* context, int copy, std::uint8_t* bytes) {
    auto& board = *static_cast<Board*>(context);
    if (board.read_status != TUMBLESIGHT_STORE_OK) return board.read_status;
    if (board.stored[copy].empty()) return TUMBLESIGHT_STORE_BLANK;
    std::copy(board.stored[copy].begin(), board.stored[copy].end(), bytes);
    return TUMBLESIGHT_STORE_OK;
  }
  static tumblesight_store_status write(void* context, int copy, const std::uint8_t* bytes) {
    auto& board = *static_cast<Board*>(context);
    if (board.fails_to_write) return TUMBLESIGHT_STORE_FAILED;
    board.stored[copy].assign(bytes, bytes + TUMBLESIGHT_STORED_BYTES);
    return TUMBLESIGHT_STORE_OK;
  }
};

class CInterface : public ::testing::Test {
 protected:
  CInterface() {
    settings.bank[0].image = aligned_image();
    settings.bank[0].image_bytes = test_model_image().size();
    settings.reset_cause = TUMBLESIGHT_RESET_POWER_ON;
    inputs.now_ns = kStart_ns;
  }
  // The test's model at an address that is a multiple of 64.
  static const std::uint8_t* aligned_image(const std::vector<std::uint8_t>& bytes = test_model_image()) {
    static std::vector<std::uint8_t> room(test_model_image().size() + 64);
    std::uint8_t* const image = room.data() + (64 - reinterpret_cast<std::uintptr_t>(room.data()) % 64) % 64;
    std::copy(bytes.begin(), bytes.end(), image);
    return image;
  }
  tumblesight_status init() { return tumblesight_init(memory.data(), memory.size(), &settings, &app); }
  void use_store() {
    settings.context = &board;
    settings.read_stored = Board::read;
    settings.write_stored = Board::write;
  }
  const tumblesight_outputs& step() {
    inputs.now_ns += TUMBLESIGHT_PERIOD_NS;
    const tumblesight_outputs* outputs = nullptr;
    EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_OK);
    return *outputs;
  }
  // With a frame of this cycle.
  const tumblesight_outputs& step_frame(unsigned scene = 0) {
    image = good_frame(++sequence_number, inputs.now_ns + TUMBLESIGHT_PERIOD_NS, scene);
    frame = {
        image.exposure_time_ns, image.sequence_number, image.fov_urad, image.rays, image.ranges.data(), {}};
    inputs.frames = &frame;
    inputs.frame_count = 1;
    const tumblesight_outputs& outputs = step();
    inputs.frame_count = 0;
    return outputs;
  }
  const tumblesight_outputs& step_command(const std::vector<std::uint8_t>& packet) {
    const tumblesight_command command{packet.data(), packet.size()};
    inputs.commands = &command;
    inputs.command_count = 1;
    const tumblesight_outputs& outputs = step();
    inputs.command_count = 0;
    return outputs;
  }
  static std::vector<std::uint8_t> set_mode(hal::Mode mode) {
    return packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kSetMode),
                     {static_cast<std::uint8_t>(mode)});
  }
  static std::vector<std::uint8_t> bytes_of(const hal::CommandPacket& packet) {
    return {packet.bytes.begin(), packet.bytes.begin() + packet.size};
  }
  static std::uint32_t refused(const tumblesight_outputs& outputs, hal::CommandRefusal why) {
    return outputs.telemetry.commands_refused_by[static_cast<std::size_t>(why)];
  }

  std::vector<std::uint8_t> memory = std::vector<std::uint8_t>(TUMBLESIGHT_MEMORY_BYTES);
  tumblesight_settings settings{};
  tumblesight_inputs inputs{};
  tumblesight_app* app = nullptr;
  gnc::RangeImage image;
  tumblesight_frame frame{};
  std::uint32_t sequence_number = 0;
  Board board;
};

TEST_F(CInterface, GivesAnAttitudeForAFrame) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  const tumblesight_outputs& outputs = step_frame();
  EXPECT_EQ(outputs.attitude.time_ns, inputs.now_ns);
  EXPECT_EQ(outputs.attitude.sequence_number, 1U);
  EXPECT_TRUE(outputs.attitude.validity == TUMBLESIGHT_VALID ||
              outputs.attitude.validity == TUMBLESIGHT_DOUBTFUL);
  EXPECT_EQ(outputs.attitude.frames_since_reset, 1U);
  EXPECT_EQ(outputs.telemetry.frames_used, 1U);
  EXPECT_EQ(outputs.telemetry.mode, static_cast<int>(hal::Mode::kRun));
  EXPECT_TRUE(outputs.duties_done);
  EXPECT_FALSE(outputs.has_dump);
  EXPECT_EQ(step().attitude.validity, TUMBLESIGHT_NO_FRAME);
}

TEST_F(CInterface, TwoObjectsWithTheSameInputsAreInTheSameState) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  std::vector<std::uint8_t> other_memory(TUMBLESIGHT_MEMORY_BYTES + 7);
  tumblesight_app* other = nullptr;
  ASSERT_EQ(tumblesight_init(other_memory.data() + 7, TUMBLESIGHT_MEMORY_BYTES, &settings, &other),
            TUMBLESIGHT_OK);
  for (unsigned k = 0; k < 4; ++k) {
    const std::uint32_t before = tumblesight_state_crc32(app);
    step_frame(k);
    inputs.frame_count = 1;
    EXPECT_EQ(tumblesight_step(other, &inputs, nullptr), TUMBLESIGHT_OK);
    inputs.frame_count = 0;
    EXPECT_NE(tumblesight_state_crc32(app), before);
    EXPECT_EQ(tumblesight_state_crc32(app), tumblesight_state_crc32(other));
  }
}

TEST_F(CInterface, FitsIntoItsMemoryAtAnyAddress) {
  for (std::size_t offset = 0; offset < 128; ++offset)
    EXPECT_LE(tumblesight_memory_bytes(memory.data() + offset), std::size_t{TUMBLESIGHT_MEMORY_BYTES})
        << offset;
  const std::size_t needed = tumblesight_memory_bytes(memory.data());
  EXPECT_EQ(tumblesight_init(memory.data(), needed - 1, &settings, &app), TUMBLESIGHT_TOO_LITTLE_MEMORY);
  EXPECT_EQ(app, nullptr);
  EXPECT_EQ(tumblesight_init(memory.data(), needed, &settings, &app), TUMBLESIGHT_OK);
  // The limit is not much larger than what is needed.
  EXPECT_GT(needed, std::size_t{TUMBLESIGHT_MEMORY_BYTES} * 3 / 4);
}

TEST_F(CInterface, RefusesWrongSettings) {
  EXPECT_EQ(tumblesight_init(nullptr, memory.size(), &settings, &app), TUMBLESIGHT_NULL_ARGUMENT);
  EXPECT_EQ(tumblesight_init(memory.data(), memory.size(), nullptr, &app), TUMBLESIGHT_NULL_ARGUMENT);
  EXPECT_EQ(tumblesight_init(memory.data(), memory.size(), &settings, nullptr), TUMBLESIGHT_NULL_ARGUMENT);
  settings.read_stored = Board::read;
  EXPECT_EQ(init(), TUMBLESIGHT_NULL_ARGUMENT);
  settings.read_stored = nullptr;
  constexpr int kUnknownCause = 4;
  std::memcpy(&settings.reset_cause, &kUnknownCause, sizeof kUnknownCause);
  EXPECT_EQ(init(), TUMBLESIGHT_BAD_RESET_CAUSE);
  settings.reset_cause = TUMBLESIGHT_RESET_OTHER;
  settings.bank[0].image += 1;
  EXPECT_EQ(init(), TUMBLESIGHT_MISALIGNED_IMAGE);
  settings.bank[0].image -= 1;
  settings.bank[0].writable = memory.data();
  EXPECT_EQ(init(), TUMBLESIGHT_OTHER_ADDRESS);
  EXPECT_EQ(app, nullptr);
}

TEST_F(CInterface, WithoutAModelItIsSafeAndReports) {
  settings.bank[0].image_bytes -= 1;
  ASSERT_EQ(init(), TUMBLESIGHT_NO_MODEL);
  const tumblesight_outputs& outputs = step_frame();
  EXPECT_EQ(outputs.telemetry.mode, static_cast<int>(hal::Mode::kSafe));
  EXPECT_EQ(outputs.attitude.validity, TUMBLESIGHT_STANDBY);
  settings.bank[0].image_bytes += 1;
  settings.expected_target = "another";
  EXPECT_EQ(init(), TUMBLESIGHT_NO_MODEL);
  settings.expected_target = kTestTarget;
  EXPECT_EQ(init(), TUMBLESIGHT_OK);
}

TEST_F(CInterface, RefusesWrongInputs) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  const std::uint32_t before = tumblesight_state_crc32(app);
  const tumblesight_outputs* outputs = nullptr;
  EXPECT_EQ(tumblesight_step(nullptr, &inputs, &outputs), TUMBLESIGHT_NULL_ARGUMENT);
  EXPECT_EQ(tumblesight_step(app, nullptr, &outputs), TUMBLESIGHT_NULL_ARGUMENT);
  inputs.frame_count = 1;
  EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_NULL_ARGUMENT);
  inputs.frame_count = 0;
  inputs.command_count = 1;
  EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_NULL_ARGUMENT);
  const std::vector<tumblesight_command> commands(TUMBLESIGHT_MAX_COMMANDS + 1);
  inputs.commands = commands.data();
  inputs.command_count = commands.size();
  EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_TOO_MANY);
  const std::vector<tumblesight_frame> frames(TUMBLESIGHT_MAX_FRAMES + 1);
  inputs.command_count = 0;
  inputs.frames = frames.data();
  inputs.frame_count = frames.size();
  EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_TOO_MANY);
  EXPECT_EQ(outputs, nullptr);
  EXPECT_EQ(tumblesight_state_crc32(app), before) << "nothing was done";
}

TEST_F(CInterface, EveryStatusHasItsText) {
  std::vector<std::string> texts;
  for (int status = TUMBLESIGHT_OK; status <= TUMBLESIGHT_MISALIGNED_ARGUMENT; ++status)
    texts.emplace_back(tumblesight_status_text(static_cast<tumblesight_status>(status)));
  std::sort(texts.begin(), texts.end());
  EXPECT_EQ(std::unique(texts.begin(), texts.end()), texts.end());
  constexpr int kUnknown = 99;
  tumblesight_status status{};
  std::memcpy(&status, &kUnknown, sizeof kUnknown);
  EXPECT_STREQ(tumblesight_status_text(status), "unknown status");
}

TEST_F(CInterface, FramesThatAreNoneAreCountedAsBad) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  image = good_frame(1, inputs.now_ns);
  std::array<tumblesight_frame, 2> frames{};
  frames[0] = {image.exposure_time_ns, 1, image.fov_urad, image.rays, nullptr, {}};
  frames[1] = {image.exposure_time_ns, 1, image.fov_urad, TUMBLESIGHT_MAX_RAYS + 1, image.ranges.data(), {}};
  inputs.frames = frames.data();
  inputs.frame_count = frames.size();
  inputs.frames_dropped = 5;
  const tumblesight_outputs& outputs = step();
  EXPECT_EQ(outputs.telemetry.frames_bad, 2U);
  EXPECT_EQ(outputs.telemetry.frames_overflowed, 5U);
}

TEST_F(CInterface, TakesTheNewestOfSeveralFrames) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  const gnc::RangeImage first = good_frame(1, inputs.now_ns + 1'000'000'000, 1);
  const gnc::RangeImage second = good_frame(2, inputs.now_ns + 2'000'000'000, 2);
  std::array<tumblesight_frame, 2> frames{};
  frames[0] = {first.exposure_time_ns, 1, first.fov_urad, first.rays, first.ranges.data(), {}};
  frames[1] = {second.exposure_time_ns, 2, second.fov_urad, second.rays, second.ranges.data(), {}};
  inputs.frames = frames.data();
  inputs.frame_count = frames.size();
  const tumblesight_outputs& outputs = step();
  EXPECT_EQ(outputs.attitude.sequence_number, 2U);
  EXPECT_EQ(outputs.telemetry.frames_superseded, 1U);
}

// The attitude at the exposure is that of the frame, the one now that of the inputs.
TEST_F(CInterface, TheChasersAttitudeIsTheNearestInTime) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  image = good_frame(1, inputs.now_ns + TUMBLESIGHT_PERIOD_NS - 500'000'000);
  const tumblesight_chaser at_exposure{image.exposure_time_ns, {1 << 30, 0, 0, 0}, true};
  frame = {image.exposure_time_ns, 1, image.fov_urad, image.rays, image.ranges.data(), at_exposure};
  inputs.frames = &frame;
  inputs.frame_count = 1;
  inputs.chaser = {inputs.now_ns + TUMBLESIGHT_PERIOD_NS, {1 << 30, 0, 0, 0}, true};
  EXPECT_EQ(step().telemetry.frames_without_chaser, 0U);
  image = good_frame(2, inputs.now_ns + TUMBLESIGHT_PERIOD_NS - 500'000'000, 2);
  frame.exposure_time_ns = image.exposure_time_ns;
  frame.sequence_number = 2;
  frame.chaser.is_known = false;
  inputs.chaser.is_known = false;
  EXPECT_EQ(step().telemetry.frames_without_chaser, 1U);
}

TEST_F(CInterface, CarriesOutCommandsAndCountsRefusals) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(step_command(set_mode(hal::Mode::kStandby)).telemetry.mode,
            static_cast<int>(hal::Mode::kStandby));
  std::vector<std::uint8_t> wrong = set_mode(hal::Mode::kRun);
  wrong[7] ^= 1;
  EXPECT_EQ(refused(step_command(wrong), hal::CommandRefusal::kWrongChecksum), 1U);
  EXPECT_EQ(step_command({}).telemetry.commands_refused, 2U);
  EXPECT_EQ(step_command(std::vector<std::uint8_t>(70'000)).telemetry.commands_refused, 3U);
  inputs.commands_dropped = 3;
  EXPECT_EQ(refused(step(), hal::CommandRefusal::kNoRoom), 3U);
}

TEST_F(CInterface, ChecksSignedCommandsIfItHasKeys) {
  tumblesight_command_keys keys{};
  for (std::size_t slot = 0; slot < kTestKeys.slots.size(); ++slot)
    std::copy(kTestKeys.slots[slot].begin(), kTestKeys.slots[slot].end(), keys.slots[slot]);
  keys.spacecraft_id = kTestKeys.spacecraft_id;
  settings.command_keys = &keys;
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  keys = {};  // they are copied
  const auto standby = bytes_of(signed_as({}, 1, set_mode(hal::Mode::kStandby)));
  EXPECT_EQ(step_command(standby).telemetry.mode, static_cast<int>(hal::Mode::kStandby));
  EXPECT_EQ(refused(step_command(standby), hal::CommandRefusal::kReplayed), 1U);
  EXPECT_EQ(refused(step_command(set_mode(hal::Mode::kRun)), hal::CommandRefusal::kForged), 1U);
}

// Its checksum stays right.
std::vector<std::uint8_t> with_apid(std::uint16_t apid, std::vector<std::uint8_t> packet) {
  const auto first = static_cast<std::uint8_t>(0x18 | apid >> 8),
             second = static_cast<std::uint8_t>(apid & 0xFF);
  packet[7] = static_cast<std::uint8_t>(packet[7] ^ packet[0] ^ packet[1] ^ first ^ second);
  packet[0] = first;
  packet[1] = second;
  return packet;
}

TEST_F(CInterface, UsesTheCallersApids) {
  constexpr tumblesight_apids kApids{0x2A0, 0x2A1, 0x2A2, 0x2A3, TUMBLESIGHT_MAX_APID};
  settings.apids = kApids;
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(step_command(with_apid(0x2A0, set_mode(hal::Mode::kStandby))).telemetry.mode,
            static_cast<int>(hal::Mode::kStandby));
  EXPECT_EQ(refused(step_command(set_mode(hal::Mode::kRun)), hal::CommandRefusal::kMalformed), 1U);
  const auto dump =
      packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kMemoryDump), {0, 0, 0, 0, 0, 0, 16});
  EXPECT_TRUE(step_command(with_apid(0x2A0, dump)).has_dump);
  std::array<std::uint8_t, TUMBLESIGHT_MAX_PACKET_BYTES> packet{};
  std::set<int> apids;
  while (tumblesight_take_packet(app, packet.data(), packet.size()) > 0)
    apids.insert((packet[0] & 7) * 256 + packet[1]);
  EXPECT_EQ(apids, (std::set<int>{0x2A1, 0x2A2, 0x2A3, TUMBLESIGHT_MAX_APID}));
}

TEST_F(CInterface, RefusesApidsThatAreEqualOrTooLarge) {
  constexpr tumblesight_apids kGood{1, 2, 3, 4, 5};
  constexpr std::uint16_t tumblesight_apids::*kAll[] = {
      &tumblesight_apids::command, &tumblesight_apids::attitude_report, &tumblesight_apids::telemetry,
      &tumblesight_apids::event, &tumblesight_apids::memory_dump};
  for (const auto one : kAll) {
    settings.apids = kGood;
    settings.apids.*one = TUMBLESIGHT_MAX_APID + 1;
    EXPECT_EQ(init(), TUMBLESIGHT_BAD_APIDS);
    for (const auto other : kAll) {
      settings.apids = kGood;
      settings.apids.*one = kGood.*other;
      EXPECT_EQ(init(), one == other ? TUMBLESIGHT_OK : TUMBLESIGHT_BAD_APIDS);
    }
  }
}

TEST_F(CInterface, InitialParametersAreAllowedAndThoseOfTheFirstStart) {
  tumblesight_parameters parameters{};
  tumblesight_initial_parameters(nullptr);
  tumblesight_initial_parameters(&parameters);
  tumblesight_wrong_parameter wrong{};
  EXPECT_EQ(tumblesight_check_parameters(&parameters, &wrong), TUMBLESIGHT_OK);
  EXPECT_EQ(tumblesight_check_parameters(nullptr, &wrong), TUMBLESIGHT_NULL_ARGUMENT);
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(tumblesight_set_parameters(app, &parameters), TUMBLESIGHT_OK);
  EXPECT_EQ(tumblesight_set_parameters(nullptr, &parameters), TUMBLESIGHT_NULL_ARGUMENT);
  EXPECT_EQ(tumblesight_set_parameters(app, nullptr), TUMBLESIGHT_NULL_ARGUMENT);
  EXPECT_EQ(step().telemetry.table_crc32, crc32_of(kInitialTable));
}

// Each field is at its place: its lowest value less one, or its highest plus one, is refused with its name.
TEST_F(CInterface, EveryParameterIsCheckedAndNamed) {
  tumblesight_parameters initial{};
  tumblesight_initial_parameters(&initial);
  const std::vector<std::string> names = {"PredictedError_urad", "AttitudeJump_urad",      "CycleBudget_us",
                                          "ScrubBlocks",         "FutureTolerance_us",     "MaxFrameAge_ms",
                                          "LongestCoast_ms",     "ChaserTimeTolerance_us", "EventsOfAKind",
                                          "EventWindow_cycles",  "LongestWithoutChaser_ms"};
  for (std::size_t i = 0; i < kParameters; ++i) {
    tumblesight_parameters parameters = initial;
    const std::uint32_t highest = config::kParameterRules[i].highest, beyond = highest + 1;
    auto* const field = reinterpret_cast<std::uint8_t*>(&parameters) + i * sizeof beyond;
    std::memcpy(field, &highest, sizeof highest);
    EXPECT_EQ(tumblesight_check_parameters(&parameters, nullptr), TUMBLESIGHT_OK) << i;
    std::memcpy(field, &beyond, sizeof beyond);
    EXPECT_EQ(tumblesight_check_parameters(&parameters, nullptr), TUMBLESIGHT_BAD_PARAMETER) << i;
    tumblesight_wrong_parameter wrong{};
    EXPECT_EQ(tumblesight_check_parameters(&parameters, &wrong), TUMBLESIGHT_BAD_PARAMETER);
    EXPECT_EQ(wrong.name, names[i]);
    EXPECT_EQ(wrong.value, beyond);
    EXPECT_EQ(wrong.lowest, config::kParameterRules[i].lowest);
    EXPECT_EQ(wrong.highest, highest);
  }
  for (int fault = 0; fault < TUMBLESIGHT_FAULTS; ++fault) {
    tumblesight_parameters parameters = initial;
    parameters.fault_rules[fault].good_cycles = 0;
    tumblesight_wrong_parameter wrong{};
    EXPECT_EQ(tumblesight_check_parameters(&parameters, &wrong), TUMBLESIGHT_BAD_PARAMETER);
    EXPECT_EQ(wrong.name, "rule of fault " + std::to_string(fault));
    EXPECT_EQ(wrong.value >> 24, initial.fault_rules[fault].cycles);
  }
}

TEST_F(CInterface, ParametersAreUsedAndStored) {
  use_store();
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  step();
  tumblesight_parameters parameters{};
  tumblesight_initial_parameters(&parameters);
  parameters.max_frame_age_ms = 100;
  parameters.fault_rules[5] = {2, 4, 7, TUMBLESIGHT_RESPONSE_SAFE};  // an outage
  ASSERT_EQ(tumblesight_set_parameters(app, &parameters), TUMBLESIGHT_OK);
  const std::uint32_t crc32 = step().telemetry.table_crc32;
  EXPECT_NE(crc32, crc32_of(kInitialTable));
  EXPECT_EQ(step().telemetry.mode, static_cast<int>(hal::Mode::kSafe)) << "two cycles without a frame";
  parameters.scrub_blocks = 0;
  EXPECT_EQ(tumblesight_set_parameters(app, &parameters), TUMBLESIGHT_BAD_PARAMETER);
  EXPECT_EQ(step().telemetry.table_crc32, crc32) << "nothing changed";
  settings.reset_cause = TUMBLESIGHT_RESET_COMMANDED;
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(step().telemetry.table_crc32, crc32) << "resumed from the store";
}

TEST_F(CInterface, VersionIsTheProjects) {
  EXPECT_STREQ(tumblesight_version(), TUMBLESIGHT_TEST_VERSION);
}

TEST_F(CInterface, EventsHaveTexts) {
  EXPECT_STREQ(tumblesight_event_text(33), "frame too old");
  EXPECT_STREQ(tumblesight_event_text(0), "unknown");
}

TEST_F(CInterface, ResumesFromItsStore) {
  use_store();
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  step_command(set_mode(hal::Mode::kStandby));
  EXPECT_EQ(board.stored[0].size(), std::size_t{TUMBLESIGHT_STORED_BYTES});
  settings.reset_cause = TUMBLESIGHT_RESET_COMMANDED;
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(step().telemetry.mode, static_cast<int>(hal::Mode::kStandby));
}

TEST_F(CInterface, AStoreThatFailsIsReported) {
  use_store();
  board.fails_to_write = true;
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_GT(step().telemetry.state_writes_failed, 0U);
  for (const int status : {int{TUMBLESIGHT_STORE_FAILED}, int{TUMBLESIGHT_STORE_DAMAGED}, 99}) {
    std::memcpy(&board.read_status, &status, sizeof status);
    EXPECT_NE(init(), TUMBLESIGHT_NULL_ARGUMENT);
    EXPECT_GT(step().telemetry.state_writes_failed, 0U) << status;
  }
}

TEST_F(CInterface, MeasuresWithTheCallersStopwatch) {
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  step_frame();
  EXPECT_EQ(step_frame().telemetry.cycle_us, 0U);
  settings.context = &board;
  settings.stopwatch_ns = Board::now_ns;
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(step_frame().telemetry.cycle_us, 0U) << "there is no cycle before";
  EXPECT_GE(step_frame().telemetry.cycle_us, 1000U);
}

// Verifies TS-TIM-130.
TEST_F(CInterface, CutsTheRegistrationOfALateStepShortIfItHasAStopwatch) {
  aligned_image(image_with_surface());
  settings.context = &board;
  for (const bool has_stopwatch : {false, true}) {
    settings.stopwatch_ns = has_stopwatch ? Board::now_ns : nullptr;
    board.tick_ns = 400'000'000;
    ASSERT_EQ(init(), TUMBLESIGHT_OK);
    step_frame(1);
    const tumblesight_outputs& outputs = step_frame(2);
    EXPECT_EQ(outputs.telemetry.frames_used, 2U);
    EXPECT_EQ(outputs.telemetry.registrations_cut_short, has_stopwatch ? 2U : 0U);
  }
}

TEST_F(CInterface, LoadsAModelIntoAWritableBank) {
  alignas(64) static std::array<std::uint8_t, 64 * 1024> writable{};
  settings.bank[1] = {writable.data(), 0, writable.data(), writable.size()};
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(step().telemetry.bank_status[1], 0);
}

TEST_F(CInterface, GivesItsOutputsAsPacketsOnce) {
  std::array<std::uint8_t, TUMBLESIGHT_MAX_PACKET_BYTES> packet{};
  ASSERT_EQ(init(), TUMBLESIGHT_OK);
  EXPECT_EQ(tumblesight_take_packet(app, packet.data(), packet.size()), 0U) << "before the first step";
  const tumblesight_outputs& outputs = step_command(
      packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kMemoryDump), {0, 0, 0, 0, 0, 0, 16}));
  EXPECT_TRUE(outputs.has_dump) << "events: " << outputs.event_count;
  EXPECT_EQ(tumblesight_take_packet(app, packet.data(), packet.size() - 1), 0U) << "too little room";
  std::vector<int> apids;
  while (const std::size_t size = tumblesight_take_packet(app, packet.data(), packet.size())) {
    EXPECT_EQ(size, 7U + packet[4] * 256U + packet[5]);
    apids.push_back((packet[0] & 7) * 256 + packet[1]);
  }
  std::vector<int> expected{0x1F1, 0x1F2};
  expected.insert(expected.end(), outputs.event_count, 0x1F3);
  if (outputs.has_dump) expected.push_back(0x1F4);
  EXPECT_EQ(apids, expected);
  EXPECT_EQ(tumblesight_take_packet(nullptr, packet.data(), packet.size()), 0U);
  EXPECT_EQ(tumblesight_take_packet(app, nullptr, packet.size()), 0U);
}

}  // namespace
}  // namespace tumblesight::fsw
