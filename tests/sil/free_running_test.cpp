#include <gtest/gtest.h>

#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

// Verifies TS-TIM-070, TS-TIM-080.
TEST(FreeRunning, FlightAnswersOnItsOwnTimer) {
  SilSettings settings = test::settings();
  settings.free_running = true;
  settings.speed = 27.0;  // a period of 100 ms
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(2, 1), {});
  EXPECT_EQ(recording.failure, "");
  EXPECT_EQ(recording.steps_planned, 20U);
  EXPECT_LE(recording.steps_missed, 2U) << "a busy machine may lose a cycle or two";
  EXPECT_EQ(recording.flight_heap_allocations, 0U);
  for (std::size_t k = 0; k < recording.steps.size(); ++k) {
    const StepResult& step = recording.steps[k];
    if (!step.answered) continue;
    EXPECT_EQ(step.attitude.sequence_number, k);
    EXPECT_EQ(step.attitude.exposure_time_ns, step.time_ns);
    EXPECT_GT(step.attitude.time_ns, step.time_ns) << "a cycle comes after the exposure of its frame";
  }
  const std::string log = test::read_file(settings.flight_log_path);
  EXPECT_NE(log.find("fixed priority"), std::string::npos) << log;
  EXPECT_NE(log.find("memory locked"), std::string::npos) << log;
}

// Verifies TS-TIM-080. A sensor at twice the rate of the cycle.
TEST(FreeRunning, FramesThatANewerOneSupersedesAreCountedAndNotMissed) {
  SilSettings settings = test::settings();
  settings.free_running = true;
  settings.speed = 5.4;  // a cycle every 500 ms
  ScenarioSettings fast{Condition::kNominal, 12};
  fast.disturbances.period_s = 1.35;
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, {make_sequence(fast, 1, 0)}, {});
  EXPECT_EQ(run.failure, "");
  EXPECT_GE(run.frames_superseded, 4U);
  EXPECT_LE(run.frames_superseded, 7U);
  EXPECT_LE(run.steps_missed, 2U) << "a busy machine may lose a cycle or two";
}

TEST(FreeRunning, MissingAttitudeOfTheLastFrameIsCountedAsMissed) {
  SilSettings settings = test::settings();
  settings.free_running = true;
  settings.speed = 27.0;
  std::vector<Sequence> sequences{make_sequence({Condition::kNominal, 5}, 1, 0)};
  sequences[0].frames.back().range_m = 5000.0;  // beyond the sensor's range: an empty frame
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, sequences, {});
  EXPECT_EQ(recording.failure, "");
  ASSERT_EQ(recording.steps.size(), 5U);
  EXPECT_FALSE(recording.steps.back().answered);
  EXPECT_GE(recording.steps_missed, 1U);
}

TEST(FreeRunning, NeedsASpeed) {
  SilSettings settings = test::settings();
  settings.free_running = true;
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(recording.failure.find("needs a speed"), std::string::npos) << recording.failure;
}

}  // namespace
}  // namespace tumblesight::sim
