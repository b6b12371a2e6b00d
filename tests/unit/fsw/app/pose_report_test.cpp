// The registered pose in the attitude report. The attitudes of the random network are those of no target, so
// that no pose here is verified; tests/sil/shipped_network_test.cpp has those that are.
#include <algorithm>
#include <array>

#include "gnc/rcnn/model_image.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class PoseReport : public AppFixture {
 protected:
  void init_with_surface() {
    store.fill(image_with_surface());
    init(store);
  }
  const gnc::PoseEstimate& pose() { return AppMemory::estimate(*app).pose; }
};

TEST_F(PoseReport, IsThatOfTheEstimate) {
  init_with_surface();
  for (int k = 0; k < 3; ++k) step_good();
  const hal::AttitudeReport& report = out->attitude;
  ASSERT_TRUE(pose().is_known());
  EXPECT_EQ(report.pose_doubts, pose().doubts);
  EXPECT_EQ(report.pose_frames, pose().poses);
  EXPECT_EQ(report.pose_q_lrf_trf, pose().state.q_lrf_trf);
  EXPECT_EQ(report.pose_origin_lrf_um, pose().state.origin_lrf_um);
  EXPECT_EQ(report.pose_rate_lrf_urad_s, pose().state.rate_lrf_urad_s);
  EXPECT_EQ(report.pose_velocity_lrf_um_s, pose().state.velocity_lrf_um_s);
  EXPECT_EQ(report.pose_sigma, pose().covariance.sigma);
  EXPECT_EQ(report.pose_correlation_q15, pose().covariance.correlation_q15);
  EXPECT_EQ(report.pose_mean_square_q8, static_cast<std::uint32_t>(pose().evidence.mean_square_q8()));
  EXPECT_EQ(report.pose_unexplained_ppm, pose().evidence.unexplained_ppm());
  EXPECT_EQ(report.pose_missing_ppm, pose().evidence.missing_ppm());
  EXPECT_EQ(report.pose_advantage_q8, pose().conservative_llr_q8);
  // The cycle is at the time of the exposure.
  EXPECT_EQ(report.pose_origin_lrf_now_um, report.pose_origin_lrf_um);
  EXPECT_EQ(report.pose_velocity_lrf_now_um_s, report.pose_velocity_lrf_um_s);
  EXPECT_EQ(out->telemetry.poses_verified, 0U);
}

class LateCycle : public PoseReport {
 protected:
  LateCycle() { init_with_surface(); }
  // A step with a frame in a cycle that began `since_start_us` ago.
  void step_late(std::uint32_t since_start_us, bool keeps_deadline = true) {
    const gnc::RangeImage frame = good_frame(sequence_number + 1, next_time_ns(), sequence_number);
    StepInputs inputs;
    inputs.frame = &frame;
    inputs.timing.stopwatch = keeps_deadline ? &stopwatch : nullptr;
    inputs.timing.start_ns = stopwatch.time_ns;
    stopwatch.time_ns += std::uint64_t{since_start_us} * 1000;
    ++sequence_number;
    step(inputs);
  }
};

// Verifies TS-TIM-130.
TEST_F(LateCycle, CutsItsRegistrationShortAndSaysSo) {
  for (int k = 0; k < 3; ++k) step_late(1'181'249);
  ASSERT_EQ(pose().doubts & gnc::kPoseCoasts, 0U);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 0U);
  step_late(1'181'250);  // 7/8 of the budget
  EXPECT_EQ(validity(), Validity::kValid) << "the network's attitude is on time";
  EXPECT_EQ(out->attitude.sequence_number, sequence_number);
  EXPECT_EQ(out->attitude.pose_doubts & hal::kPoseDoubtCoasts, hal::kPoseDoubtCoasts);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 1U);
  ASSERT_EQ(events(EventId::kRegistrationCutShort), 1);
  EXPECT_EQ(argument(EventId::kRegistrationCutShort, 0), static_cast<std::int32_t>(sequence_number));
  EXPECT_EQ(argument(EventId::kRegistrationCutShort, 1), 1'181);
  EXPECT_TRUE(hal::depends_on_wall_clock(EventId::kRegistrationCutShort));
  step_late(0);
  EXPECT_EQ(out->attitude.pose_doubts & hal::kPoseDoubtCoasts, 0) << "the track goes on";
  EXPECT_EQ(out->telemetry.registrations_cut_short, 1U);
}

TEST_F(LateCycle, IsNoFaultIfItsReportIsOnTime) {
  for (int k = 0; k < 8; ++k) step_late(1'200'000);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 8U);
  EXPECT_EQ(out->telemetry.faults_persisting & 1U << static_cast<int>(hal::Fault::kDeadline), 0U);
}

TEST_F(LateCycle, WithoutASurfaceHasNothingToCutShort) {
  init_with_model();
  for (int k = 0; k < 3; ++k) step_late(2'000'000);
  ASSERT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 0U);
  EXPECT_EQ(events(EventId::kRegistrationCutShort), 0);
}

TEST_F(LateCycle, HasTheBudgetThatTheGroundSets) {
  AppMemory::state(*app).table[Parameter::kCycleBudget_us] = 2'000'000;
  AppMemory::commit(*app);
  step_late(1'749'999);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 0U);
  step_late(1'750'000);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 1U);
}

TEST_F(LateCycle, OfARunThatKeepsNoDeadlineRegistersAsAnyOther) {
  for (int k = 0; k < 3; ++k) step_late(2'000'000'000, false);
  EXPECT_EQ(pose().doubts & gnc::kPoseCoasts, 0U);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 0U);
}

TEST_F(LateCycle, IsNoneOfAStopwatchThatRunsBackwards) {
  stopwatch.time_ns = 5'000'000'000;
  stopwatch.tick_ns = std::uint64_t{0} - 1'000;
  for (int k = 0; k < 3; ++k) step_late(0);
  EXPECT_EQ(pose().doubts & gnc::kPoseCoasts, 0U);
  EXPECT_EQ(out->telemetry.registrations_cut_short, 0U);
}

TEST_F(PoseReport, IsUnknownWithoutASurface) {
  init_with_model();
  step_good();
  ASSERT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.pose_doubts, hal::kPoseDoubtUnknown);
  EXPECT_EQ(out->attitude.pose_q_lrf_trf, gnc::kIdentityQ30);
  EXPECT_EQ(out->attitude.pose_sigma, hal::AttitudeReport().pose_sigma);
  EXPECT_EQ(events(EventId::kPoseDoubtful), 0);
}

TEST_F(PoseReport, AVerdictThatIsLostIsReportedOnce) {
  init_with_surface();
  step_good();
  AppMemory::state(*app).pose_is_verified = true;
  AppMemory::commit(*app);
  step_good();
  ASSERT_NE(out->attitude.pose_doubts, 0);
  EXPECT_EQ(events(EventId::kPoseDoubtful), 1);
  EXPECT_EQ(argument(EventId::kPoseDoubtful, 0), static_cast<std::int32_t>(sequence_number));
  EXPECT_EQ(argument(EventId::kPoseDoubtful, 1), out->attitude.pose_doubts);
  step_good();
  EXPECT_EQ(events(EventId::kPoseDoubtful), 0);
}

}  // namespace
}  // namespace tumblesight::fsw
