// The component of F Prime, over a stub of its generated base class.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "fsw/programs/fprime/AttitudeInit/AttitudeInit.hpp"
#include "tests/support/golden_replay.hpp"
#include "tests/support/make_packet.hpp"

namespace Tumblesight {

class AttitudeInitTester {
 public:
  static tumblesight_app* app(AttitudeInit& component) { return component.app_; }
};

namespace {

using namespace tumblesight;

constexpr std::size_t kQueueDepth = 60;

class AttitudeInitComponent : public ::testing::Test {
 protected:
  AttitudeInitComponent() {
    settings.bank[0].image = replay.model();
    settings.bank[0].image_bytes = replay.model_bytes();
    settings.reset_cause = TUMBLESIGHT_RESET_POWER_ON;
    component->init(kQueueDepth);
    auto& topology = component->topology;
    topology.packet_allocate = [this](FwSizeType size) {
      return has_buffers ? Fw::Buffer(packet, std::max<FwSizeType>(size, sizeof packet)) : Fw::Buffer();
    };
    topology.packet_out = [this](Fw::Buffer& buffer) {
      replay.take(buffer.getData(), buffer.getSize());
      ++packets;
    };
    topology.frame_return = [this](Fw::Buffer& buffer) { frames_returned += buffer.getSize() > 0 ? 1 : 0; };
    topology.command_return = [this](Fw::Buffer& buffer) {
      commands_returned += buffer.getSize() > 0 ? 1 : 0;
    };
    topology.watchdog = [this](U32) { ++kicks; };
  }

  void deliver_frame() {
    component->frameIn(
        frame.exposure_time_ns, frame.sequence_number, frame.fov_urad, frame.rays,
        {reinterpret_cast<U8*>(frame.ranges.data()), std::uint64_t{2} * frame.rays * frame.rays});
  }
  void deliver_command() { component->commandIn({noop.data(), noop.size()}); }
  void cycle_at(I64 time_ns) {
    component->topology.time_us = time_ns / 1000;
    component->schedIn(0);
  }
  void cycle() { cycle_at((component->topology.time_us + 2'700'000) * 1000); }

  test::GoldenReplay replay;
  std::unique_ptr<AttitudeInit> component = std::make_unique<AttitudeInit>("attitudeInit");
  tumblesight_settings settings{};
  gnc::RangeImage frame;
  std::vector<U8> noop = fsw::packet_of(1);
  bool has_buffers = true;
  U8 packet[TUMBLESIGHT_MAX_PACKET_BYTES] = {};
  int packets = 0, frames_returned = 0, commands_returned = 0, kicks = 0;
};

TEST_F(AttitudeInitComponent, HasTheGoldenDigest) {
  component->boot(settings);
  component->topology.chaser_get = [this](I64& time_ns, I32& qw, I32& qx, I32& qy, I32& qz) {
    const gnc::ChaserAttitude chaser = replay.navigation.attitude_at(time_ns);
    time_ns = chaser.time_ns;
    qw = chaser.q_inertial_lrf[0], qx = chaser.q_inertial_lrf[1];
    qy = chaser.q_inertial_lrf[2], qz = chaser.q_inertial_lrf[3];
    return chaser.valid;
  };
  while (replay.recording.has_next()) {
    replay.recording.read_next(frame);
    deliver_frame();
    cycle_at(frame.exposure_time_ns);
    replay.end_cycle(tumblesight_state_crc32(AttitudeInitTester::app(*component)));
  }
  EXPECT_EQ(replay.digest(), test::GoldenReplay::golden_digest());
  EXPECT_EQ(frames_returned, 20);
  EXPECT_EQ(kicks, 20);
  EXPECT_EQ(component->topology.frames_used, 20U);
  EXPECT_EQ(component->topology.frames_used, replay.telemetry().frames_used);
  EXPECT_EQ(component->topology.poses_verified, replay.telemetry().poses_verified);
  EXPECT_EQ(component->topology.mode, static_cast<U32>(replay.telemetry().mode));
  EXPECT_EQ(component->topology.packets_lost, 0U);
  ASSERT_FALSE(component->topology.events.empty());
  EXPECT_EQ(component->topology.events[0].severity, "ACTIVITY_HI");
}

TEST_F(AttitudeInitComponent, ReportsWhyItDidNotBoot) {
  cycle();
  EXPECT_EQ(packets, 0) << "not booted";
  settings.bank[0].image_bytes -= 1;
  component->boot(settings);
  settings.bank[0].image += 1;
  component->boot(settings);
  ASSERT_EQ(component->topology.boot_failures.size(), 2U);
  EXPECT_EQ(component->topology.boot_failures[0], tumblesight_status_text(TUMBLESIGHT_NO_MODEL));
  EXPECT_EQ(component->topology.boot_failures[1], tumblesight_status_text(TUMBLESIGHT_MISALIGNED_IMAGE));
  deliver_command();
  cycle();
  EXPECT_EQ(commands_returned, 1) << "also without an application";
}

TEST_F(AttitudeInitComponent, CarriesOutWhatFitsIntoAStepAndLeavesTheRest) {
  component->boot(settings);
  for (int i = 0; i < 10; ++i) deliver_command();
  cycle();
  EXPECT_EQ(commands_returned, 10) << "they are copied";
  EXPECT_EQ(replay.telemetry().commands_accepted, std::uint32_t{TUMBLESIGHT_MAX_COMMANDS});
  cycle();
  EXPECT_EQ(replay.telemetry().commands_accepted, 10U);
  replay.recording.read_next(frame);
  for (int i = 0; i < TUMBLESIGHT_MAX_FRAMES + 1; ++i) deliver_frame();
  cycle();
  EXPECT_EQ(frames_returned, TUMBLESIGHT_MAX_FRAMES);
  cycle();
  EXPECT_EQ(frames_returned, TUMBLESIGHT_MAX_FRAMES + 1);
}

// Whatever waits before it.
TEST_F(AttitudeInitComponent, NothingKeepsSetModeSafeOut) {
  std::vector<U8> segment = fsw::packet_of(5, std::vector<U8>(4 + 1024)), safe = fsw::packet_of(3, {3}),
                  unknown = fsw::packet_of(99);
  for (std::vector<U8>* flood : {&segment, &noop, &unknown}) {
    component->boot(settings);
    for (std::size_t i = 1; i < kQueueDepth; ++i) component->commandIn({flood->data(), flood->size()});
    component->commandIn({safe.data(), safe.size()});
    cycle();
    cycle();
    EXPECT_EQ(replay.telemetry().mode, hal::Mode::kSafe) << int{(*flood)[6]};
  }
}

TEST_F(AttitudeInitComponent, CountsWhatDoesNotFitIntoItsQueue) {
  component->boot(settings);
  for (std::size_t i = 0; i < kQueueDepth; ++i) deliver_command();
  deliver_command();
  deliver_command();
  replay.recording.read_next(frame);
  deliver_frame();
  EXPECT_EQ(commands_returned, 2);
  EXPECT_EQ(frames_returned, 1);
  cycle();
  cycle();
  EXPECT_EQ(replay.telemetry().frames_overflowed, 1U);
  constexpr auto kNoRoom = static_cast<std::size_t>(hal::CommandRefusal::kNoRoom);
  EXPECT_EQ(replay.telemetry().commands_refused_by[kNoRoom], 2U + kQueueDepth - 15U)
      << "by this queue and that of the application";
}

TEST_F(AttitudeInitComponent, FramesThatAreNoneAreCountedAsBad) {
  component->boot(settings);
  replay.recording.read_next(frame);
  U8* const bytes = reinterpret_cast<U8*>(frame.ranges.data());
  component->frameIn(0, 1, frame.fov_urad, 100, {bytes, 19'999});
  component->frameIn(0, 1, frame.fov_urad, 100, {bytes + 1, 20'000});
  cycle();
  EXPECT_EQ(replay.telemetry().frames_bad, 2U);
}

TEST_F(AttitudeInitComponent, EventsHaveTheSeverityOfTheApplications) {
  component->boot(settings);
  component->topology.watchdog = nullptr;
  noop[7] ^= 1;
  deliver_command();
  cycle();
  const auto& events = component->topology.events;
  EXPECT_TRUE(
      std::any_of(events.begin(), events.end(), [](const auto& e) { return e.severity == "WARNING_LO"; }));
  EXPECT_EQ(kicks, 0);
}

TEST_F(AttitudeInitComponent, ReportsErrors) {
  settings.bank[0].image_bytes -= 1;
  component->boot(settings);
  cycle();
  const auto& events = component->topology.events;
  EXPECT_TRUE(
      std::any_of(events.begin(), events.end(), [](const auto& e) { return e.severity == "WARNING_HI"; }));
}

TEST_F(AttitudeInitComponent, CountsPacketsForWhichThereIsNoBuffer) {
  component->boot(settings);
  cycle();
  const int with_buffers = packets;
  EXPECT_GE(with_buffers, 2);
  has_buffers = false;
  cycle();
  EXPECT_EQ(packets, with_buffers);
  EXPECT_GE(component->topology.packets_lost, 2U);
  component->topology.packet_allocate = [this](FwSizeType) { return Fw::Buffer(packet, 10); };
  const U32 lost = component->topology.packets_lost;
  cycle();
  EXPECT_GT(component->topology.packets_lost, lost) << "too small";
}

}  // namespace
}  // namespace Tumblesight
