#include "fsw/app/cycle.hpp"

#include "hal/fake/fake_lidar.hpp"
#include "hal/fake/fake_link.hpp"
#include "tests/unit/fsw_app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class Cycle : public AppFixture {
 protected:
  Cycle() : workspace(std::make_unique<CycleWorkspace>()) { init_with_model(); }
  CyclePublished run() {
    now_ns = next_time_ns();
    return run_cycle(*app, lidar, link, now_ns, *workspace);
  }
  Validity last_validity() const { return static_cast<Validity>(link.attitudes.back().validity); }

  std::unique_ptr<CycleWorkspace> workspace;
  hal::fake::FakeLidar lidar;
  hal::fake::FakeLink link;
};

TEST_F(Cycle, PublishesOneAttitudeOneTelemetryAndEveryEvent) {
  lidar.add(next_frame());
  link.add(command(Opcode::kNoop));
  const CyclePublished published = run();
  EXPECT_EQ(published.attitudes, 1);
  EXPECT_EQ(published.telemetries, 1);
  EXPECT_EQ(published.events, 2);
  ASSERT_EQ(link.attitudes.size(), 1U);
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.telemetry.size(), 1U);
  ASSERT_EQ(link.events.size(), 2U);
  EXPECT_EQ(link.events[0].id, static_cast<int>(EventId::kModelActivated));
  EXPECT_EQ(link.events[1].id, static_cast<int>(EventId::kCommandAccepted));
}

TEST_F(Cycle, NothingOfTheLastCycleIsLeftOver) {
  lidar.add(next_frame());
  link.add(command(Opcode::kNoop));
  run();
  run();
  EXPECT_EQ(last_validity(), Validity::kNoFrame);
  EXPECT_EQ(link.telemetry.back().commands_accepted, 1U);
  EXPECT_EQ(link.telemetry.back().frames_used, 1U);
}

TEST_F(Cycle, CommandsBeyondTheLimitWaitForTheNextCycle) {
  for (int i = 0; i < config::kMaxCommandsPerStep + 3; ++i) link.add(command(Opcode::kNoop));
  run();
  EXPECT_EQ(link.waiting(), 3U);
  EXPECT_EQ(link.telemetry.back().commands_accepted, static_cast<unsigned>(config::kMaxCommandsPerStep));
  run();
  EXPECT_EQ(link.telemetry.back().commands_accepted, static_cast<unsigned>(config::kMaxCommandsPerStep + 3));
}

TEST_F(Cycle, BacklogOfFramesDrainsInsteadOfStaying) {
  for (std::uint32_t number = 1; number <= 4; ++number) lidar.add(good_frame(number, now_ns));
  for (std::uint32_t number = 5; !link.attitudes.size() || lidar.waiting() > 0; ++number) {
    ASSERT_LT(number, 12U);
    lidar.add(good_frame(number, next_time_ns()));
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
