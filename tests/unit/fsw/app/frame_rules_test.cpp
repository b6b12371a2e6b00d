#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class FrameRules : public AppFixture {
 protected:
  FrameRules() {
    init_with_model();
    step_good();
    step_good();
    before_ = out->telemetry;
    crc_ = estimator_crc();
  }

  // Expects the frame to be refused with `id` and only counters to change. Returns the telemetry.
  const hal::Telemetry& expect_refused(const gnc::RangeImage& frame, EventId id) {
    step_frame(frame);
    expect_refusal(id);
    return out->telemetry;
  }
  void expect_refusal(EventId id) {
    EXPECT_EQ(validity(), Validity::kFrameRefused);
    EXPECT_EQ(out->event_count, 1);
    ASSERT_NE(event(id), nullptr);
    EXPECT_NE(event(id)->severity, Severity::kInformation);
    EXPECT_EQ(out->telemetry.frames_refused, before_.frames_refused + 1);
    EXPECT_EQ(out->telemetry.frames_used, before_.frames_used);
    EXPECT_EQ(out->telemetry.estimator_resets, before_.estimator_resets);
    EXPECT_EQ(out->telemetry.frames_duplicate + out->telemetry.frames_stale + out->telemetry.frames_bad, 1U);
    EXPECT_EQ(estimator_crc(), crc_);
  }

  hal::Telemetry before_;
  std::uint32_t crc_ = 0;
};

TEST_F(FrameRules, GoodFramesOnePeriodApartBuildASequence) {
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 3U);
  EXPECT_EQ(out->attitude.sequence_number, sequence_number);
  EXPECT_EQ(out->attitude.exposure_time_ns, now_ns);
  EXPECT_EQ(out->event_count, 0);
  EXPECT_EQ(out->telemetry.frames_used, 3U);
  EXPECT_EQ(out->telemetry.frames_refused + out->telemetry.frames_missing, 0U);
  EXPECT_NE(estimator_crc(), crc_);
}

TEST_F(FrameRules, MissingFramesAreCountedAndReportedOncePerOutage) {
  step(StepInputs{});
  EXPECT_EQ(validity(), Validity::kNoFrame);
  EXPECT_EQ(events(EventId::kFrameMissing), 1);
  EXPECT_EQ(estimator_crc(), crc_);
  step(StepInputs{});
  EXPECT_EQ(out->telemetry.frames_missing, 2U);
  EXPECT_EQ(events(EventId::kFrameMissing), 0);
  step_good();
  step(StepInputs{});
  EXPECT_EQ(events(EventId::kFrameMissing), 1);
  EXPECT_EQ(out->telemetry.frames_refused, 0U);
}

TEST_F(FrameRules, RepeatedSequenceNumberIsRefused) {
  gnc::RangeImage frame = next_frame();
  frame.sequence_number = sequence_number;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameDuplicate).frames_duplicate, 1U);
}

TEST_F(FrameRules, ExposureNotAfterTheLastOneIsRefused) {
  gnc::RangeImage frame = next_frame();
  frame.exposure_time_ns = now_ns;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameExposureBackwards).frames_stale, 1U);
}

TEST_F(FrameRules, OldExposureIsRefused) {
  now_ns += 10 * config::kFramePeriod_ns;
  gnc::RangeImage frame = next_frame();
  frame.exposure_time_ns = next_time_ns() - kMaxFrameAge_ns - 1;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameStale).frames_stale, 1U);
  EXPECT_EQ(argument(EventId::kFrameStale, 1), 2970);
}

TEST_F(FrameRules, ExposureInTheFutureIsRefused) {
  gnc::RangeImage frame = next_frame();
  frame.exposure_time_ns += 2'000'000;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameFromFuture).frames_stale, 1U);
  EXPECT_EQ(argument(EventId::kFrameFromFuture, 1), 2);
}

TEST_F(FrameRules, EmptyFrameIsRefused) {
  gnc::RangeImage frame = next_frame();
  frame.ranges.fill(0);
  EXPECT_EQ(expect_refused(frame, EventId::kFrameBad).frames_bad, 1U);
  EXPECT_EQ(argument(EventId::kFrameBad, 1), static_cast<int>(gnc::FrameStatus::kEmpty));
}

TEST_F(FrameRules, FlatFrameIsRefused) {
  gnc::RangeImage frame = next_frame();
  for (std::uint16_t& range : frame.ranges) range = range == 0 ? 0 : 6400;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameBad).frames_bad, 1U);
  EXPECT_EQ(argument(EventId::kFrameBad, 1), static_cast<int>(gnc::FrameStatus::kFlat));
}

TEST_F(FrameRules, WrongRayCountIsRefused) {
  gnc::RangeImage frame = next_frame();
  frame.rays = 129;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameBad).frames_bad, 1U);
  EXPECT_EQ(argument(EventId::kFrameBad, 1), static_cast<int>(gnc::FrameStatus::kBadRayCount));
  EXPECT_EQ(argument(EventId::kFrameBad, 2), 129);
}

TEST_F(FrameRules, ImpossibleFieldOfViewIsRefused) {
  gnc::RangeImage frame = next_frame();
  frame.fov_urad = gnc::kMaxFov_urad + 1;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameBad).frames_bad, 1U);
  EXPECT_EQ(argument(EventId::kFrameBad, 1), static_cast<int>(gnc::FrameStatus::kBadFov));
}

TEST_F(FrameRules, FrameOfWrongSizeIsRefused) {
  StepInputs inputs;
  inputs.frame_wrong_size = 1;
  step(inputs);
  expect_refusal(EventId::kFrameWrongSize);
  EXPECT_EQ(out->telemetry.frames_bad, 1U);
  EXPECT_EQ(out->telemetry.frames_missing, 0U);
}

TEST_F(FrameRules, BadFrameAfterAGapDoesNotResetTheEstimator) {
  now_ns += 5 * config::kFramePeriod_ns;
  gnc::RangeImage frame = next_frame();
  frame.ranges.fill(0);
  expect_refused(frame, EventId::kFrameBad);
}

TEST_F(FrameRules, RefusedFrameBesideAGoodOneIsCountedAndTheGoodOneUsed) {
  const gnc::RangeImage frame = next_frame();
  StepInputs inputs;
  inputs.frame = &frame;
  inputs.dropped[0] = {gnc::FrameVerdict::kDuplicate, sequence_number, frame.exposure_time_ns};
  inputs.dropped_count = 1;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 3U);
  EXPECT_EQ(out->telemetry.frames_duplicate, 1U);
  EXPECT_EQ(out->telemetry.frames_refused, before_.frames_refused + 1);
}

TEST_F(FrameRules, SupersededFrameIsCountedAndNeitherRefusedNorSkipped) {
  ++sequence_number;
  const gnc::RangeImage frame = next_frame();
  StepInputs inputs;
  inputs.frame = &frame;
  inputs.dropped[0] = {gnc::FrameVerdict::kSuperseded, sequence_number, frame.exposure_time_ns - 1};
  inputs.dropped_count = 1;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->telemetry.frames_superseded, 1U);
  EXPECT_EQ(out->telemetry.frames_refused, before_.frames_refused);
  EXPECT_EQ(out->telemetry.sequence_gaps, 0U) << "it has arrived";
  EXPECT_EQ(out->event_count, 0);
}

TEST_F(FrameRules, SupersededFrameOfACycleThatUsesNoneIsNotSkippedLater) {
  gnc::RangeImage frame = next_frame();
  frame.ranges.fill(0);
  StepInputs inputs;
  inputs.frame = &frame;
  inputs.dropped[0] = {gnc::FrameVerdict::kSuperseded, ++sequence_number, frame.exposure_time_ns - 1};
  inputs.dropped_count = 1;
  frame.sequence_number = ++sequence_number;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kFrameRefused);
  step_good();
  EXPECT_EQ(out->telemetry.sequence_gaps, 1U) << "the refused frame alone";
  step_good();
  EXPECT_EQ(out->telemetry.sequence_gaps, 1U);
  sequence_number += 1;
  step_good();
  EXPECT_EQ(out->telemetry.sequence_gaps, 2U) << "nothing is left over";
}

TEST_F(FrameRules, ExposureWithinTheToleranceAheadOfTheCycleIsUsed) {
  for (const std::int64_t ahead_ns : {std::int64_t{1}, kFutureTolerance_ns}) {
    gnc::RangeImage frame = next_frame();
    frame.exposure_time_ns += ahead_ns;
    sequence_number = frame.sequence_number;
    step_frame(frame);
    EXPECT_EQ(validity(), Validity::kValid) << ahead_ns;
  }
}

TEST_F(FrameRules, ExposureTooSoonAfterTheLastOneIsRefused) {
  const std::int64_t last_ns = now_ns;
  gnc::RangeImage frame = next_frame();
  frame.exposure_time_ns = last_ns + gnc::kShortestInterval_ns - 1;
  EXPECT_EQ(expect_refused(frame, EventId::kFrameTooSoon).frames_stale, 1U);
  EXPECT_EQ(argument(EventId::kFrameTooSoon, 1), 99);
}

// Verifies TS-FDIR-170.
TEST_F(FrameRules, RepeatedRangesAreRefusedAcrossGapsAndResets) {
  const gnc::RangeImage last = good_frame(sequence_number, now_ns, sequence_number - 1);
  const auto repeat = [&] {
    gnc::RangeImage frame = last;
    frame.sequence_number = ++sequence_number;
    frame.exposure_time_ns = next_time_ns();
    step_frame(frame);
    EXPECT_EQ(validity(), Validity::kFrameRefused);
    EXPECT_EQ(events(EventId::kFrameRepeated), 1);
    EXPECT_EQ(argument(EventId::kFrameRepeated, 0), static_cast<std::int32_t>(sequence_number));
  };
  repeat();
  EXPECT_EQ(estimator_crc(), crc_);
  step(StepInputs{});
  repeat();
  EXPECT_EQ(estimator_crc(), crc_);
  step_commands({command(FunctionCode::kResetSequence)});
  repeat();
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun)});
  repeat();
  EXPECT_EQ(out->telemetry.frames_repeated, 4U);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
}

// Verifies TS-EST-184.
TEST_F(FrameRules, WithoutTheChasersAttitudeTheReportSaysSo) {
  gnc::RangeImage frame = next_frame();
  StepInputs inputs;
  const auto step_with = [&](const gnc::ChaserAttitude& chaser) {
    frame = next_frame();
    sequence_number = frame.sequence_number;
    inputs.frame = &frame;
    inputs.chaser = chaser;
    step(inputs);
    return (out->attitude.doubts & hal::kDoubtChaserUnknown) != 0;
  };
  const auto known = [&](std::int64_t off_ns) {
    return gnc::ChaserAttitude{next_time_ns() + off_ns, gnc::kIdentityQ30, true};
  };
  EXPECT_TRUE(step_with({next_time_ns(), gnc::kIdentityQ30, false}));
  EXPECT_FALSE(step_with(known(0)));
  EXPECT_EQ(event(EventId::kEstimatorResetByGap)->arguments, (std::array<std::int32_t, 3>{2700, 3, 1}));
  EXPECT_EQ(out->attitude.frames_since_reset, 1U) << "no turn is known in the track before";
  EXPECT_FALSE(step_with(known(kChaserTimeTolerance_ns)));
  EXPECT_FALSE(step_with(known(-kChaserTimeTolerance_ns)));
  EXPECT_EQ(out->attitude.frames_since_reset, 3U);
  const std::uint32_t crc = estimator_crc();
  gnc::ChaserAttitude unsound = known(0);
  unsound.q_inertial_lrf[1] = 1 << 29;
  unsound.time_ns += config::kFramePeriod_ns;
  std::uint32_t refused = 0;
  for (const gnc::ChaserAttitude& chaser : {known(kChaserTimeTolerance_ns + 1), unsound}) {
    step_with(chaser);
    EXPECT_EQ(validity(), Validity::kFrameRefused);
    EXPECT_EQ(argument(EventId::kFrameWithoutChaser, 0), static_cast<std::int32_t>(sequence_number));
    EXPECT_EQ(argument(EventId::kFrameWithoutChaser, 1), static_cast<std::int32_t>(2700 * ++refused));
    EXPECT_EQ(out->telemetry.frames_without_chaser, refused);
    EXPECT_EQ(out->telemetry.frames_refused, before_.frames_refused + refused);
    EXPECT_EQ(estimator_crc(), crc);
  }
  EXPECT_FALSE(step_with(known(0)));
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 4U) << "the track has coasted";
}

TEST_F(FrameRules, SkippedNumbersAreCountedAndTheFrameUsedWithoutReset) {
  sequence_number += 3;
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->telemetry.sequence_gaps, 3U);
  ASSERT_NE(event(EventId::kSequenceSkipped), nullptr);
  EXPECT_EQ(event(EventId::kSequenceSkipped)->arguments, (std::array<std::int32_t, 3>{103, 106, 3}));
  EXPECT_EQ(out->attitude.frames_since_reset, 3U);
}

TEST_F(FrameRules, NumbersGoingBackAreOneGapAndTheFrameUsed) {
  sequence_number = 0;
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->telemetry.sequence_gaps, 1U);
  ASSERT_NE(event(EventId::kSequenceSkipped), nullptr);
  EXPECT_EQ(argument(EventId::kSequenceSkipped, 2), -1);
}

// Verifies TS-EST-182.
TEST_F(FrameRules, TrackIsKeptOverAnyTimeUpToTheLongestCoast) {
  std::uint32_t frames = 2;
  for (const std::int64_t gap_ns : {std::int64_t{200'000'000}, std::int64_t{1'000'000'000},
                                    std::int64_t{5'400'000'000}, kLongestCoast_ns}) {
    now_ns += gap_ns - config::kFramePeriod_ns;
    step_good();
    EXPECT_EQ(validity(), Validity::kValid);
    EXPECT_EQ(out->attitude.frames_since_reset, ++frames) << gap_ns;
    EXPECT_EQ(out->event_count, 0);
  }
  EXPECT_EQ(out->telemetry.estimator_resets, before_.estimator_resets);
}

// Verifies TS-EST-182.
TEST_F(FrameRules, TrackIsGivenUpAfterTheLongestCoastWithAnEvent) {
  now_ns += kLongestCoast_ns - config::kFramePeriod_ns + 1'000'000;
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  EXPECT_EQ(out->telemetry.estimator_resets, before_.estimator_resets + 1);
  ASSERT_NE(event(EventId::kEstimatorResetByGap), nullptr);
  EXPECT_EQ(event(EventId::kEstimatorResetByGap)->arguments, (std::array<std::int32_t, 3>{21601, 2, 0}));
}

TEST_F(FrameRules, CycleTimeNotAdvancingRefusesTheFrameButNotTheCommand) {
  const std::int64_t next = next_time_ns();
  now_ns -= config::kFramePeriod_ns;  // so that the next cycle has the time of the last one
  gnc::RangeImage frame = next_frame();
  StepInputs inputs;
  inputs.frame = &frame;
  inputs.commands[0] = command(FunctionCode::kNoop);
  inputs.command_count = 1;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kFrameRefused);
  ASSERT_NE(event(EventId::kCycleTimeNotAdvancing), nullptr);
  EXPECT_EQ(event(EventId::kCycleTimeNotAdvancing)->arguments, (std::array<std::int32_t, 3>{0, 1, 0}));
  EXPECT_EQ(out->telemetry.frames_stale, 1U);
  EXPECT_EQ(out->telemetry.frames_refused, 1U);
  EXPECT_EQ(out->telemetry.commands_accepted, 1U);
  EXPECT_EQ(estimator_crc(), crc_);
  ASSERT_EQ(next_time_ns(), next);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 3U);
}

TEST_F(FrameRules, CycleTimeGoingBackWithoutFrameIsReportedAndCountsMissing) {
  now_ns -= 3 * config::kFramePeriod_ns;
  step(StepInputs{});
  EXPECT_EQ(validity(), Validity::kNoFrame);
  ASSERT_NE(event(EventId::kCycleTimeNotAdvancing), nullptr);
  EXPECT_EQ(argument(EventId::kCycleTimeNotAdvancing, 0), -5400);
  EXPECT_EQ(out->telemetry.frames_missing, 1U);
}

TEST_F(FrameRules, CycleTimeJumpingFarBackCostsOneCycle) {
  now_ns -= 100 * config::kFramePeriod_ns;
  step_good();
  EXPECT_EQ(validity(), Validity::kFrameRefused);
  EXPECT_EQ(out->event_count, 1);
  EXPECT_EQ(events(EventId::kCycleTimeNotAdvancing), 1);
  EXPECT_EQ(out->telemetry.estimator_resets, before_.estimator_resets + 1);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U) << "earlier frames do not belong to this sequence";
  EXPECT_EQ(out->event_count, 0);
  step_good();
  EXPECT_EQ(out->attitude.frames_since_reset, 2U);
}

TEST_F(FrameRules, CycleTimeGlitchForwardCostsOneCycle) {
  const std::int64_t before_glitch_ns = now_ns;
  now_ns += 100 * config::kFramePeriod_ns;
  step_good();
  EXPECT_EQ(validity(), Validity::kValid) << "a glitch cannot be distinguished from a pause yet";
  now_ns = before_glitch_ns + config::kFramePeriod_ns;
  step_good();
  EXPECT_EQ(validity(), Validity::kFrameRefused);
  EXPECT_EQ(events(EventId::kCycleTimeNotAdvancing), 1);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
}

TEST_F(FrameRules, EventsOfTheBusiestCycleFit) {
  init_with_model();  // its event comes with the next cycle
  step_good();
  init_with_model();
  sequence_number += 5;
  now_ns += 10 * config::kFramePeriod_ns;
  const gnc::RangeImage frame = next_frame();
  StepInputs inputs;
  inputs.frame = &frame;
  inputs.dropped[0] = {gnc::FrameVerdict::kStale, sequence_number - 1, 0};
  inputs.dropped_count = 1;
  inputs.command_count = config::kMaxCommandsPerStep;
  for (hal::CommandPacket& one : inputs.commands) one = command(FunctionCode::kNoop);
  step(inputs);
  EXPECT_EQ(out->event_count, 1 + config::kMaxCommandsPerStep + 1)
      << "events of model, commands and stale frame";
  EXPECT_EQ(app->mode(), Mode::kRun);
}

}  // namespace
}  // namespace tumblesight::fsw
