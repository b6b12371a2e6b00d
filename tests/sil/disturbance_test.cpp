#include <gtest/gtest.h>

#include "sim/report/sil_report.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint32_t kFrames = 8;

SilRunResult run_with(const Disturbances& disturbances) {
  ScenarioSettings scenario{Condition::kNominal, kFrames};
  scenario.disturbances = disturbances;
  SilSettings settings = test::settings();
  settings.ego_motion = !disturbances.no_ego_motion;
  const std::vector<Sequence> sequences{make_sequence(scenario, 4, 0), make_sequence(scenario, 4, 1)};
  SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, sequences, {});
  EXPECT_EQ(run.failure, "");
  EXPECT_EQ(run.steps_missed, 0U);
  EXPECT_EQ(run.steps.size(), 2 * kFrames);
  return run;
}

// Verifies TS-SIL-100.
TEST(Disturbance, LostFramesAreNotSentAndOweNoAttitude) {
  Disturbances disturbances;
  disturbances.lost_frames = 2;
  const SilRunResult run = run_with(disturbances);
  for (const StepResult& step : run.steps) {
    const bool lost = step.frame_index == kFrames - 3 || step.frame_index == kFrames - 2;
    EXPECT_EQ(gives_attitude(step.attitude), !lost) << "frame " << step.frame_index;
    EXPECT_EQ(step.attitude.validity == hal::Validity::kNoFrame, lost);
  }
  EXPECT_EQ(run.steps.back().telemetry.frames_missing, 4U);
  EXPECT_EQ(run.pictures.size(), 2 * (kFrames - 2));
  EXPECT_TRUE(run_faults(run).empty());
}

// Verifies TS-SIL-100.
TEST(Disturbance, StepsFollowTheExposuresOfTheSensor) {
  Disturbances disturbances;
  disturbances.period_s = 1.5;
  disturbances.period_jitter = 0.2;
  const SilRunResult run = run_with(disturbances);
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const StepResult& step = run.steps[k];
    EXPECT_EQ(step.telemetry.time_ns, step.time_ns);
    if (step.frame_index == 0) continue;
    const double interval_s = 1e-9 * static_cast<double>(step.time_ns - run.steps[k - 1].time_ns);
    EXPECT_GE(interval_s, 1.5 * 0.8);
    EXPECT_LE(interval_s, 1.5 * 1.2);
  }
  EXPECT_EQ(run.steps[kFrames].time_ns - run.steps[kFrames - 1].time_ns, kFramePeriod_ns);
}

// Verifies TS-SIL-100.
TEST(Disturbance, TheChasersAttitudeReachesTheFlightProgramUnlessItIsWithheld) {
  for (const bool withheld : {false, true}) {
    Disturbances disturbances;
    disturbances.chaser_rate_deg_s = 5.0;
    disturbances.no_ego_motion = withheld;
    for (const StepResult& step : run_with(disturbances).steps) {
      if (step.frame_index == 0) continue;
      EXPECT_EQ((step.attitude.doubts & hal::kDoubtChaserUnknown) != 0, withheld) << step.frame_index;
    }
  }
}

// Verifies TS-SIL-100, TS-SIL-020.
TEST(Disturbance, OneSeedGivesOneTrace) {
  Disturbances disturbances;
  disturbances.chaser_rate_deg_s = 5.0;
  disturbances.loss_share = 0.3;
  disturbances.frozen = 1;
  EXPECT_EQ(run_with(disturbances).trace_crc32, run_with(disturbances).trace_crc32);
}

}  // namespace
}  // namespace tumblesight::sim
