// Telecommands through the C interface: which of them get a place, and when they are carried out.
// Verifies TS-SEC-080.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "fsw/c/tumblesight_c.h"
#include "hal/messages/command_refusal.hpp"
#include "hal/messages/function_code.hpp"
#include "hal/messages/mode.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

using Packet = std::vector<std::uint8_t>;

Packet of(hal::FunctionCode function, const std::vector<std::uint8_t>& arguments = {}) {
  return packet_of(static_cast<std::uint8_t>(function), arguments);
}
Packet set_mode(hal::Mode mode) {
  return of(hal::FunctionCode::kSetMode, {static_cast<std::uint8_t>(mode)});
}

class CCommandPlaces : public ::testing::Test {
 protected:
  void boot(const tumblesight_command_keys* keys = nullptr) {
    images.resize(test_model_image().size() + 64);
    std::uint8_t* const image =
        images.data() + (64 - reinterpret_cast<std::uintptr_t>(images.data()) % 64) % 64;
    std::copy(test_model_image().begin(), test_model_image().end(), image);
    tumblesight_settings settings{};
    settings.bank[0] = {image, test_model_image().size(), nullptr, 0};
    settings.command_keys = keys;
    inputs = {};
    inputs.now_ns = kStart_ns;
    ASSERT_EQ(tumblesight_init(memory.data(), memory.size() * 8, &settings, &app), TUMBLESIGHT_OK);
  }
  tumblesight_status put(const Packet& packet) {
    return tumblesight_put_command(app, packet.data(), packet.size());
  }
  tumblesight_status put(const hal::CommandPacket& packet) {
    return tumblesight_put_command(app, packet.bytes.data(), packet.size);
  }
  // With these commands among the inputs.
  const tumblesight_telemetry& step(const std::vector<Packet>& packets = {}) {
    std::vector<tumblesight_command> commands;
    for (const Packet& packet : packets) commands.push_back({packet.data(), packet.size()});
    inputs.now_ns += TUMBLESIGHT_PERIOD_NS;
    inputs.commands = commands.data();
    inputs.command_count = commands.size();
    const tumblesight_outputs* outputs = nullptr;
    EXPECT_EQ(tumblesight_step(app, &inputs, &outputs), TUMBLESIGHT_OK);
    return outputs->telemetry;
  }
  static std::uint32_t refused(const tumblesight_telemetry& telemetry, hal::CommandRefusal why) {
    return telemetry.commands_refused_by[static_cast<std::size_t>(why)];
  }
  static constexpr auto kSafe = static_cast<int>(hal::Mode::kSafe);

  std::vector<std::uint8_t> images;
  std::vector<std::uint64_t> memory = std::vector<std::uint64_t>(TUMBLESIGHT_MEMORY_BYTES / 8);
  tumblesight_inputs inputs{};
  tumblesight_app* app = nullptr;
};

TEST_F(CCommandPlaces, WhatWaitsIsCarriedOutInOrderEightPerStep) {
  boot();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(put(of(hal::FunctionCode::kNoop)), TUMBLESIGHT_OK);
  EXPECT_EQ(put(set_mode(hal::Mode::kStandby)), TUMBLESIGHT_OK);
  EXPECT_EQ(step({set_mode(hal::Mode::kSafe)}).commands_accepted, 8U);
  const tumblesight_telemetry& telemetry = step();
  EXPECT_EQ(telemetry.commands_accepted, 12U);
  EXPECT_EQ(telemetry.mode, kSafe) << "the commands of the inputs come after those that were put";
}

// Segments of a model, NOOP, dumps, changes of the mode, and what is refused: unknown, damaged, empty.
TEST_F(CCommandPlaces, NothingKeepsSetModeSafeOut) {
  Packet damaged = of(hal::FunctionCode::kNoop), damaged_safe = set_mode(hal::Mode::kSafe);
  damaged[7] ^= 1;
  damaged_safe[7] ^= 1;
  const std::vector<std::uint8_t> segment(4 + 1024);
  for (const Packet& flood :
       {of(hal::FunctionCode::kModelLoad, segment), of(hal::FunctionCode::kNoop),
        of(hal::FunctionCode::kMemoryDump, {0, 0, 0, 0, 0, 0, 16}), set_mode(hal::Mode::kStandby),
        packet_of(99), damaged, damaged_safe, Packet(1), Packet(3000)}) {
    for (const int waiting : {8, 40}) {
      boot();
      for (int i = 0; i < waiting; ++i) static_cast<void>(put(flood));
      EXPECT_EQ(put(set_mode(hal::Mode::kSafe)), TUMBLESIGHT_OK);
      step();
      EXPECT_EQ(step().mode, kSafe) << flood.size() << ' ' << waiting;
    }
  }
}

// A caller that gives eight segments to every step, and the command as the ninth.
TEST_F(CCommandPlaces, AnUploadThroughTheInputsKeepsNoOtherCommandOut) {
  boot();
  const std::vector<Packet> segments(8,
                                     of(hal::FunctionCode::kModelLoad, std::vector<std::uint8_t>(4 + 1024)));
  for (int cycle = 0; cycle < 5; ++cycle) step(segments);
  EXPECT_EQ(put(of(hal::FunctionCode::kNoop)), TUMBLESIGHT_OK);
  EXPECT_EQ(put(set_mode(hal::Mode::kSafe)), TUMBLESIGHT_OK);
  const tumblesight_telemetry& telemetry = step(segments);
  EXPECT_EQ(telemetry.commands_accepted, 2U);
  EXPECT_EQ(telemetry.mode, kSafe);
}

TEST_F(CCommandPlaces, WhatHasNoPlaceIsDroppedAndCounted) {
  boot();
  int dropped = 0;
  for (int i = 0; i < 40; ++i) dropped += put(of(hal::FunctionCode::kNoop)) == TUMBLESIGHT_COMMAND_DROPPED;
  EXPECT_EQ(dropped, 40 - (TUMBLESIGHT_COMMAND_PLACES - 1));
  inputs.commands_dropped = 2;
  EXPECT_EQ(refused(step(), hal::CommandRefusal::kNoRoom), static_cast<unsigned>(dropped) + 2U);
  inputs.commands_dropped = UINT32_MAX;
  for (int i = 0; i < 40; ++i) static_cast<void>(put(of(hal::FunctionCode::kNoop)));
  EXPECT_EQ(refused(step(), hal::CommandRefusal::kNoRoom), UINT32_MAX) << "no count overflows";
}

TEST_F(CCommandPlaces, ForgedAndReplayedCommandsTakeNoPlace) {
  tumblesight_command_keys keys{};
  for (std::size_t slot = 0; slot < kTestKeys.slots.size(); ++slot)
    std::copy(kTestKeys.slots[slot].begin(), kTestKeys.slots[slot].end(), keys.slots[slot]);
  keys.spacecraft_id = kTestKeys.spacecraft_id;
  boot(&keys);
  const hal::CommandPacket recorded = signed_as({}, 1, of(hal::FunctionCode::kNoop));
  EXPECT_EQ(put(recorded), TUMBLESIGHT_OK);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(put(recorded), TUMBLESIGHT_COMMAND_DROPPED);
    EXPECT_EQ(put(set_mode(hal::Mode::kSafe)), TUMBLESIGHT_COMMAND_DROPPED) << "not signed";
  }
  EXPECT_EQ(put(signed_as({}, 2, set_mode(hal::Mode::kSafe))), TUMBLESIGHT_OK);
  const tumblesight_telemetry& telemetry = step();
  EXPECT_EQ(telemetry.mode, kSafe);
  EXPECT_EQ(telemetry.commands_accepted, 2U);
  EXPECT_EQ(refused(telemetry, hal::CommandRefusal::kReplayed), 100U);
  EXPECT_EQ(refused(telemetry, hal::CommandRefusal::kForged), 100U);
}

}  // namespace
}  // namespace tumblesight::fsw
