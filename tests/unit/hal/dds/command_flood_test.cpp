// Genuine commands among many forged ones, through the link's real queue and the application.
// Verifies TS-SEC-080.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "fsw/app/cycle.hpp"
#include "hal/dds/dds_link.hpp"
#include "hal/fake/fake_lidar.hpp"
#include "hal/fake/fake_model_store.hpp"
#include "hal/fake/fake_platform.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::hal::dds {
namespace {

class CommandFlood : public ::testing::Test {
 protected:
  CommandFlood() {
    store_.fill(gnc::lasting_model_image<gnc::FixedPoint>(7));
    app_->init({&stopwatch_, &store_, &fsw::kTestKeys}, nullptr);
    link_->authenticate_with(fsw::kTestKeys, app_->key_slot(), app_->command_counter());
  }
  void put(const CommandPacket& packet) {
    CommandSample sample{};
    sample.size = packet.size;
    std::copy(packet.bytes.begin(), packet.bytes.end(), std::begin(sample.bytes));
    link_->put(sample);
  }
  const Telemetry& cycle() {
    now_ns_ += fsw::config::kFramePeriod_ns;
    link_->begin_cycle(1, k_++);
    fsw::run_cycle(*app_, {lidar_, *link_, watchdog_, stopwatch_}, now_ns_, 0, *workspace_);
    link_->end_cycle(0);
    return workspace_->outputs.telemetry;
  }
  static std::uint32_t by(const Telemetry& telemetry, CommandRefusal why) {
    return telemetry.commands_refused_by[static_cast<std::size_t>(why)];
  }
  CommandPacket genuine(const std::vector<std::uint8_t>& packet) {
    return fsw::signed_with(fsw::kTestKey, ++counter_, packet);
  }

  fake::FakeStopwatch stopwatch_;
  fake::FakeModelStore store_;
  fake::FakeLidar lidar_;
  fake::FakeWatchdog watchdog_;
  std::unique_ptr<fsw::AttitudeInitApp> app_ = std::make_unique<fsw::AttitudeInitApp>();
  std::unique_ptr<fsw::CycleWorkspace> workspace_ = std::make_unique<fsw::CycleWorkspace>();
  std::unique_ptr<DdsLink> link_ = std::make_unique<DdsLink>(
      DdsLink::Gauges{[] { return std::uint32_t{0}; }, [] { return std::uint32_t{0}; }});
  std::int64_t now_ns_ = 0;
  std::uint32_t k_ = 0, counter_ = 0;
};

constexpr std::uint8_t kNoop = 1, kSetMode = 3, kModelLoad = 5, kModelBegin = 13;

TEST_F(CommandFlood, SeventyForgedPacketsACycleKeepNoGenuineCommandOut) {
  fsw::Signature thief;
  thief.key = fsw::kSecondTestKey;
  for (std::uint32_t i = 1; i <= 50; ++i) {
    for (int forged = 0; forged < 70; ++forged) {
      if (forged == 35) put(genuine(fsw::packet_of(kSetMode, {3})));
      put(fsw::signed_as(thief, counter_ + 1, fsw::packet_of(kSetMode, {2})));
    }
    const Telemetry& telemetry = cycle();
    ASSERT_EQ(telemetry.commands_accepted, i);
    ASSERT_EQ(telemetry.commands_refused, 70 * i) << "every drop is counted";
    ASSERT_EQ(by(telemetry, CommandRefusal::kForged), 70 * i);
    ASSERT_EQ(telemetry.mode, Mode::kSafe);
  }
}

TEST_F(CommandFlood, ReplayedPacketsKeepNoGenuineCommandOut) {
  const CommandPacket recorded = genuine(fsw::packet_of(kNoop));
  put(recorded);
  for (std::uint32_t i = 2; i <= 51; ++i) {
    for (int replayed = 0; replayed < 70; ++replayed) put(recorded);
    put(genuine(fsw::packet_of(kNoop)));
    const Telemetry& telemetry = cycle();
    ASSERT_EQ(telemetry.commands_accepted, i);
    ASSERT_EQ(by(telemetry, CommandRefusal::kReplayed), 70 * (i - 1));
  }
}

TEST_F(CommandFlood, ALoadOfAModelKeepsNoOtherCommandOut) {
  constexpr std::uint32_t kSegments = 100;
  put(genuine(fsw::packet_of(kModelBegin, {0})));
  cycle();
  const std::vector<std::uint8_t> segment(4 + fsw::kSegmentBytes);
  for (std::uint32_t i = 0; i < kSegments; ++i) put(genuine(fsw::packet_of(kModelLoad, segment)));
  put(genuine(fsw::packet_of(kSetMode, {3})));
  Telemetry telemetry;
  for (int i = 0; i < 10; ++i) telemetry = cycle();
  EXPECT_EQ(telemetry.mode, Mode::kSafe);
  EXPECT_EQ(telemetry.commands_accepted + by(telemetry, CommandRefusal::kNoRoom), kSegments + 2);
  EXPECT_GT(by(telemetry, CommandRefusal::kNoRoom), 0U);
}

// Within the eight cycles of a full queue, whatever genuine commands fill it before: segments of a model,
// NOOP, a change of the mode, dumps, a command that is unknown.
TEST_F(CommandFlood, NothingKeepsSetModeSafeOut) {
  const std::vector<std::uint8_t> segment(4 + fsw::kSegmentBytes);
  for (const std::vector<std::uint8_t>& flood :
       {fsw::packet_of(kModelLoad, segment), fsw::packet_of(kNoop), fsw::packet_of(kSetMode, {1}),
        fsw::packet_of(8, {0, 0, 0, 0, 0, 0, 4}), fsw::packet_of(99)}) {
    put(genuine(fsw::packet_of(kSetMode, {1})));
    ASSERT_EQ(cycle().mode, Mode::kStandby);
    for (int i = 0; i < 80; ++i) put(genuine(flood));
    put(genuine(fsw::packet_of(kSetMode, {3})));
    Mode mode = Mode::kStandby;
    for (int i = 0; i < 8; ++i) mode = cycle().mode;
    EXPECT_EQ(mode, Mode::kSafe) << int{flood[kCommandFunctionOffset]};
  }
}

TEST_F(CommandFlood, LinkFollowsARollOverOfTheKey) {
  CommandPacket activate = genuine([this] {
    std::vector<std::uint8_t> arguments{1};
    const gnc::Sha256Digest proof = proof_of_key(fsw::kTestKeys, 1, counter_ + 1);
    arguments.insert(arguments.end(), proof.begin(), proof.begin() + kCommandMacBytes);
    return fsw::packet_of(static_cast<std::uint8_t>(FunctionCode::kKeyActivate), arguments);
  }());
  put(activate);
  EXPECT_EQ(cycle().key_slot, 1);
  fsw::Signature second;
  second.key = fsw::kSecondTestKey;
  second.slot = 1;
  put(genuine(fsw::packet_of(kNoop)));
  put(fsw::signed_as(second, ++counter_, fsw::packet_of(kNoop)));
  const Telemetry& telemetry = cycle();
  EXPECT_EQ(telemetry.commands_accepted, 2U);
  EXPECT_EQ(by(telemetry, CommandRefusal::kOtherKey), 1U);
}

}  // namespace
}  // namespace tumblesight::hal::dds
