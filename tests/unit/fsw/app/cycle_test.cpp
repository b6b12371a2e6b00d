#include "fsw/app/cycle.hpp"

#include "hal/fake/fake_lidar.hpp"
#include "hal/fake/fake_link.hpp"
#include "hal/fake/fake_watchdog.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class Cycle : public AppFixture {
 protected:
  Cycle() : workspace(std::make_unique<CycleWorkspace>()) { init_with_model(); }
  void run(std::uint32_t slips = 0) {
    now_ns = next_time_ns();
    run_cycle(*app, {lidar, link, watchdog}, now_ns, slips, *workspace);
  }
  Validity last_validity() const { return link.attitudes.back().validity; }

  std::unique_ptr<CycleWorkspace> workspace;
  hal::fake::FakeLidar lidar;
  hal::fake::FakeLink link;
  hal::fake::FakeWatchdog watchdog;
};

// Verifies TS-TLM-010.
TEST_F(Cycle, PublishesOneAttitudeOneTelemetryAndEveryEvent) {
  lidar.add(next_frame());
  link.add(command(FunctionCode::kNoop));
  run();
  ASSERT_EQ(link.attitudes.size(), 1U);
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.telemetry.size(), 1U);
  ASSERT_EQ(link.events.size(), 2U);
  EXPECT_EQ(link.events[0].id, EventId::kModelActivated);
  EXPECT_EQ(link.events[1].id, EventId::kCommandAccepted);
}

// Verifies TS-FDIR-160.
TEST_F(Cycle, WatchdogIsKickedAfterAllDutiesAreDone) {
  run();
  EXPECT_EQ(watchdog.kicks, 1);
  run();
  EXPECT_EQ(watchdog.kicks, 2);
}

// Verifies TS-FDIR-160.
TEST_F(Cycle, WatchdogIsNotKickedIfDutiesAreNotDone) {
  app = std::make_unique<AttitudeInitApp>();  // never booted
  run();
  EXPECT_EQ(watchdog.kicks, 0);
  EXPECT_EQ(link.telemetry.back().mode, Mode::kSafe) << "telemetry continues";
}

TEST_F(Cycle, MissedReleasesAreCountedAndReported) {
  run(3);
  EXPECT_EQ(link.telemetry.back().cycle_slips, 3U);
  EXPECT_EQ(link.events.back().id, EventId::kCycleSlipped);
  EXPECT_TRUE(hal::depends_on_wall_clock(link.events.back().id));
}

TEST_F(Cycle, PublishesADumpInTheCycleThatAskedForIt) {
  link.add(command(FunctionCode::kModelDump, {0, 0, 0, 0, 0, 0, 4}));
  run();
  ASSERT_EQ(link.dumps.size(), 1U);
  EXPECT_EQ(link.dumps[0].bytes[0], 'T');
  run();
  EXPECT_EQ(link.dumps.size(), 1U);
}

TEST_F(Cycle, NothingIsLeftFromTheLastCycle) {
  lidar.add(next_frame());
  link.add(command(FunctionCode::kNoop));
  run();
  run();
  EXPECT_EQ(last_validity(), Validity::kNoFrame);
  EXPECT_EQ(link.telemetry.back().commands_accepted, 1U);
  EXPECT_EQ(link.telemetry.back().frames_used, 1U);
}

TEST_F(Cycle, CommandsBeyondTheLimitWaitForTheNextCycle) {
  for (int i = 0; i < config::kMaxCommandsPerStep + 3; ++i) link.add(command(FunctionCode::kNoop));
  run();
  EXPECT_EQ(link.waiting(), 3U);
  EXPECT_EQ(link.telemetry.back().commands_accepted, static_cast<unsigned>(config::kMaxCommandsPerStep));
  run();
  EXPECT_EQ(link.telemetry.back().commands_accepted, static_cast<unsigned>(config::kMaxCommandsPerStep + 3));
}

TEST_F(Cycle, BacklogOfFramesDrains) {
  for (std::uint32_t number = 1; number <= 4; ++number) lidar.add(good_frame(number, now_ns, number));
  for (std::uint32_t number = 5; !link.attitudes.size() || lidar.waiting() > 0; ++number) {
    ASSERT_LT(number, 12U);
    lidar.add(good_frame(number, next_time_ns(), number));
    run();
  }
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.attitudes.back().exposure_time_ns, now_ns);
}

TEST_F(Cycle, WrongSizeBesideAGoodFrameIsCountedAndTheFrameUsed) {
  lidar.add_wrong_size();
  lidar.add(next_frame());
  run();
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.telemetry.back().frames_bad, 1U);
  lidar.add_wrong_size();
  run();
  EXPECT_EQ(last_validity(), Validity::kFrameRefused);
  EXPECT_EQ(link.telemetry.back().frames_bad, 2U);
}

}  // namespace
}  // namespace tumblesight::fsw
