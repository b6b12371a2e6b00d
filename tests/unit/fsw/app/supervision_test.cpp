// Faults of inputs and timing: outages, slips, overruns, doubtful attitudes, and the responses to them.
#include <functional>
#include <utility>

#include "tests/support/app_memory.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class Supervision : public AppFixture {
 protected:
  Supervision() { init_with_model(); }
  void set_limit(Parameter which, std::uint32_t value) {
    std::vector<std::uint8_t> arguments{static_cast<std::uint8_t>(which)};
    append_u32(arguments, value);
    step_commands({command(FunctionCode::kSetParameter, arguments)});
    ASSERT_EQ(events(EventId::kCommandAccepted), 1);
  }
  bool persists(Fault fault) const { return (out->telemetry.faults_persisting & bit_of(fault)) != 0; }
};

// Verifies TS-FDIR-110.
TEST_F(Supervision, OutageIsAFaultAfterFourCyclesAndEndsAfterFourGoodFrames) {
  for (int cycle = 1; cycle <= 4; ++cycle) step_good();
  EXPECT_FALSE(persists(Fault::kOutage));
  for (int cycle = 1; cycle <= 3; ++cycle) {
    step(StepInputs{});
    EXPECT_FALSE(persists(Fault::kOutage)) << cycle;
  }
  gnc::RangeImage bad = next_frame();
  bad.ranges.fill(0);
  step_frame(bad);
  EXPECT_TRUE(persists(Fault::kOutage)) << "a refused frame does not end the outage";
  EXPECT_EQ(argument(EventId::kFaultPersists, 0), static_cast<int>(Fault::kOutage));
  EXPECT_EQ(argument(EventId::kFaultPersists, 1), static_cast<int>(Response::kFlag));
  for (int good = 1; good <= 3; ++good) {
    step_good();
    EXPECT_TRUE(persists(Fault::kOutage)) << good;
  }
  step_good();
  EXPECT_FALSE(persists(Fault::kOutage));
  EXPECT_EQ(argument(EventId::kFaultOver, 0), static_cast<int>(Fault::kOutage));
}

// Verifies TS-FDIR-050, TS-FDIR-110.
TEST_F(Supervision, EverySecondFrameLostIsAnOutage) {
  int cycles = 0;
  while (!persists(Fault::kOutage) && cycles < 8) {
    step(StepInputs{});
    if (!persists(Fault::kOutage)) step_good();
    cycles += 2;
  }
  EXPECT_EQ(cycles, 8);
  for (int i = 0; i < 20; ++i) {
    step_good();
    EXPECT_TRUE(persists(Fault::kOutage));
    step(StepInputs{});
    EXPECT_TRUE(persists(Fault::kOutage));
  }
}

// Verifies TS-FDIR-050, TS-FDIR-110.
TEST_F(Supervision, ThreeOfFourFramesLostIsAnOutage) {
  for (int lost = 0; lost < 3; ++lost) step(StepInputs{});
  step_good();
  EXPECT_FALSE(persists(Fault::kOutage));
  step(StepInputs{});
  EXPECT_TRUE(persists(Fault::kOutage));
}

// Verifies TS-FDIR-180.
TEST_F(Supervision, TrackThatRestartsAgainAndAgainIsAFault) {
  for (int restart = 1; restart <= 3; ++restart) {
    for (int cycle = 0; cycle < 4; ++cycle) step_good();
    EXPECT_FALSE(persists(Fault::kTrackRestarts));
    now_ns -= 3 * config::kFramePeriod_ns;  // a cycle time that goes back restarts the track
    step(StepInputs{});
    EXPECT_EQ(persists(Fault::kTrackRestarts), restart == 3);
  }
  EXPECT_EQ(argument(EventId::kFaultPersists, 0), static_cast<int>(Fault::kTrackRestarts));
  for (int cycle = 0; cycle < 15; ++cycle) step_good();
  EXPECT_TRUE(persists(Fault::kTrackRestarts));
  step_good();
  EXPECT_FALSE(persists(Fault::kTrackRestarts));
}

// Verifies TS-FDIR-180.
TEST_F(Supervision, RestartsByCommandAreNoFault) {
  for (int cycle = 0; cycle < 8; ++cycle) step_commands({command(FunctionCode::kResetSequence)});
  EXPECT_GE(out->telemetry.estimator_resets, 8U);
  EXPECT_FALSE(persists(Fault::kTrackRestarts));
}

// Verifies TS-FDIR-110.
TEST_F(Supervision, MissingFramesAreNoFaultInStandby) {
  step_commands({set_mode(Mode::kStandby)});
  for (int cycle = 0; cycle < 10; ++cycle) step(StepInputs{});
  EXPECT_EQ(out->telemetry.faults_persisting, 0U);
}

// Verifies TS-FDIR-120.
TEST_F(Supervision, SlipsAreCountedReportedAndFlaggedIfTheyPersist) {
  StepInputs inputs;
  inputs.cycle_slips = 2;
  for (int cycle = 0; cycle < 3; ++cycle) {
    step(inputs);
    EXPECT_EQ(argument(EventId::kCycleSlipped, 0), 2);
  }
  EXPECT_EQ(out->telemetry.cycle_slips, 6U);
  EXPECT_TRUE(persists(Fault::kSlip));
  EXPECT_EQ(argument(EventId::kTimingFaultPersists, 0), static_cast<int>(Fault::kSlip));
  EXPECT_TRUE(hal::depends_on_wall_clock(event(EventId::kTimingFaultPersists)->id));
  for (int good = 1; good <= 3; ++good) {
    EXPECT_TRUE(persists(Fault::kSlip));
    step(StepInputs{});
  }
  EXPECT_EQ(argument(EventId::kTimingFaultOver, 0), static_cast<int>(Fault::kSlip));
}

class CycleTimes : public Supervision {
 protected:
  // A step that is told how long the cycle before it took.
  void step_after(std::uint32_t previous_us) {
    StepInputs inputs;
    inputs.timing.previous_us = previous_us;
    step(inputs);
  }
};

// Verifies TS-FDIR-130, TS-TLM-050.
TEST_F(CycleTimes, BeyondTheirBudgetAreCountedReportedAndFlaggedIfTheyPersist) {
  step_after(1'350'000);
  EXPECT_EQ(out->telemetry.deadline_overruns, 0U) << "the initial budget";
  step_after(1'350'001);
  EXPECT_EQ(out->telemetry.deadline_overruns, 1U);
  for (int k = 0; k < 8; ++k) step_after(1'000);
  set_limit(Parameter::kCycleBudget_us, 1'000);
  step_after(1'001);
  EXPECT_EQ(events(EventId::kDeadlineOverrun), 1);
  EXPECT_EQ(argument(EventId::kDeadlineOverrun, 0), 1);
  step_after(700'000);
  EXPECT_EQ(argument(EventId::kDeadlineOverrun, 0), 700);
  EXPECT_FALSE(persists(Fault::kDeadline));
  step_after(1'001);
  EXPECT_TRUE(persists(Fault::kDeadline));
  EXPECT_EQ(argument(EventId::kTimingFaultPersists, 0), static_cast<int>(Fault::kDeadline));
  EXPECT_EQ(out->telemetry.deadline_overruns, 4U);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-TLM-050.
TEST_F(CycleTimes, FillTheHistogram) {
  for (const std::uint32_t previous_us :
       {999U, 1'000U, 3'000U, 10'000U, 30'000U, 100'000U, 300'000U, 1'000'000U})
    step_after(previous_us);
  for (const std::uint32_t count : out->telemetry.cycles_by_time) EXPECT_EQ(count, 1U);
  EXPECT_EQ(out->telemetry.cycle_max_us, 1'000'000U);
  step_after(5);
  EXPECT_EQ(out->telemetry.cycle_us, 5U);
  EXPECT_EQ(out->telemetry.cycle_max_us, 1'000'000U);
}

TEST_F(CycleTimes, ThatWereNotMeasuredAreNotCounted) {
  step_after(7);
  step_after(0);
  EXPECT_EQ(out->telemetry.cycle_us, 0U);
  EXPECT_EQ(out->telemetry.cycle_max_us, 7U);
  std::uint32_t cycles = 0;
  for (const std::uint32_t count : out->telemetry.cycles_by_time) cycles += count;
  EXPECT_EQ(cycles, 1U);
}

TEST_F(Supervision, InferenceTimeGoesToTelemetryOnly) {
  stopwatch.tick_ns = 4'000;
  step_good();
  EXPECT_EQ(out->telemetry.inference_us, 4U);
  const std::uint32_t crc_fast = app->state_crc32();

  auto slow = std::make_unique<AttitudeInitApp>();
  hal::fake::FakeStopwatch slow_stopwatch;
  slow_stopwatch.tick_ns = 400'000'000;
  boot(*slow, {&slow_stopwatch, &store, &kTestKeys, nullptr, hal::ResetCause::kPowerOn});
  const gnc::RangeImage frame = good_frame(sequence_number, now_ns, sequence_number - 1);
  StepInputs inputs;
  inputs.frame = &frame;
  slow->step(now_ns, inputs, *out);
  EXPECT_EQ(out->telemetry.inference_max_us, 400'000U);
  EXPECT_EQ(slow->state_crc32(), crc_fast) << "times within the budget are not in the digest";
}

TEST_F(Supervision, StopwatchRunningBackwardsMeasuresZero) {
  stopwatch.time_ns = 1'000'000'000;
  stopwatch.tick_ns = std::uint64_t{0} - 1'000'000;
  step_good();
  EXPECT_EQ(out->telemetry.inference_us, 0U);
  EXPECT_EQ(out->telemetry.deadline_overruns, 0U);
}

TEST_F(Supervision, StopwatchJumpingFarAheadSaturates) {
  stopwatch.tick_ns = std::uint64_t{1} << 60;
  step_good();
  EXPECT_EQ(out->telemetry.inference_us, UINT32_MAX);
}

class DoubtfulAttitudes : public Supervision {
 protected:
  DoubtfulAttitudes() {
    checks_attitudes = true;
    init_with_model();
  }
  // A frame whose content makes the random network give another attitude than the previous frame.
  void step_scene(unsigned scene) {
    const gnc::RangeImage frame = good_frame(++sequence_number, next_time_ns(), scene);
    step_frame(frame);
  }
};

// Verifies TS-FDIR-140.
TEST_F(DoubtfulAttitudes, LargeExpectedErrorIsFlaggedAndTheAttitudeStillReported) {
  set_limit(Parameter::kAttitudeJump_urad, 3'141'593);
  set_limit(Parameter::kPredictedError_urad, 17'453);
  for (unsigned cycle = 1; cycle <= 10; ++cycle) {
    step_scene(cycle);
    ASSERT_GT(out->attitude.predicted_error_urad, 17'453U)
        << "the test needs a network with a large expected error";
    EXPECT_EQ(validity(), Validity::kDoubtful);
    EXPECT_GT(out->attitude.sequence_number, 0U);
    EXPECT_EQ(persists(Fault::kErrorLarge), cycle == 10);
    EXPECT_FALSE(persists(Fault::kOutage)) << "there is an attitude";
  }
  EXPECT_EQ(out->telemetry.attitudes_doubtful, 10U);
  set_limit(Parameter::kPredictedError_urad, 3'141'593);
  step_scene(11);
  EXPECT_EQ(validity(), Validity::kValid);
}

// Verifies TS-EST-190.
TEST_F(DoubtfulAttitudes, FrameThatTheTargetDoesNotExplainIsFlaggedAndTheAttitudeStillReported) {
  gnc::ModelHeader header;
  gnc::NetworkWeights<gnc::FixedPoint> weights;
  const std::vector<std::uint8_t>& without = test_model_image();
  ASSERT_EQ(gnc::read_model_image<gnc::FixedPoint>(without.data(), without.size(), nullptr, header, weights),
            gnc::ModelStatus::kOk);
  std::vector<std::uint8_t> surface(gnc::SurfaceModel::kBytes), image(without.size());
  surface[0] = 1;  // a target of one point
  ASSERT_EQ(gnc::write_model_image(header, weights, image.data(), image.size(), {surface.data()}),
            image.size());
  store.fill(image);
  init(store);
  step_scene(1);
  EXPECT_EQ(validity(), Validity::kDoubtful);
  EXPECT_EQ(out->attitude.doubts & hal::kDoubtUnexplained, hal::kDoubtUnexplained);
  EXPECT_EQ(out->attitude.sequence_number, sequence_number);
  EXPECT_EQ(argument(EventId::kAttitudeDoubtful, 2), 2);
  EXPECT_EQ(out->telemetry.attitudes_doubtful, 1U);
}

// Verifies TS-FDIR-150.
TEST_F(DoubtfulAttitudes, JumpsAreFlaggedAndResetTheSequenceIfTheyPersist) {
  set_limit(Parameter::kPredictedError_urad, 3'141'593);
  set_limit(Parameter::kAttitudeJump_urad, 87'266);
  int doubtful = 0;
  for (unsigned i = 0; i < 40 && out->telemetry.estimator_resets < 2; ++i) {
    step_scene(1000 + 7 * i);
    if (validity() == Validity::kDoubtful) ++doubtful;
  }
  EXPECT_EQ(argument(EventId::kEstimatorResetByFault, 0), static_cast<int>(Fault::kAttitudeJump));
  EXPECT_GE(doubtful, 3);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-FDIR-170.
TEST_F(DoubtfulAttitudes, RepeatedFramesAreRefusedAndReportedIfTheyPersist) {
  set_limit(Parameter::kPredictedError_urad, 3'141'593);
  set_limit(Parameter::kAttitudeJump_urad, 3'141'593);
  gnc::RangeImage frame = next_frame();
  step_frame(frame);
  EXPECT_EQ(validity(), Validity::kValid);
  for (int repetition = 1; repetition <= 3; ++repetition) {
    ++frame.sequence_number;
    frame.exposure_time_ns = next_time_ns();
    step_frame(frame);
    EXPECT_EQ(validity(), Validity::kFrameRefused);
    EXPECT_EQ(events(EventId::kFrameRepeated), 1);
    EXPECT_EQ(persists(Fault::kFrameFrozen), repetition == 3);
  }
  step_frame(good_frame(frame.sequence_number + 1, next_time_ns(), 2));
  EXPECT_EQ(validity(), Validity::kValid) << "the sensor works again";
  EXPECT_EQ(out->telemetry.frames_repeated, 3U);
  EXPECT_EQ(out->telemetry.attitudes_doubtful, 0U);
}

// Verifies TS-FDIR-170.
TEST_F(DoubtfulAttitudes, ASensorThatIsFrozenIsSeenWithin6CyclesAlsoIfEverySecondFrameIsLost) {
  set_limit(Parameter::kPredictedError_urad, 3'141'593);
  set_limit(Parameter::kAttitudeJump_urad, 3'141'593);
  for (const bool starts_with_loss : {false, true}) {
    const gnc::RangeImage genuine = good_frame(200, next_time_ns(), starts_with_loss ? 5 : 6);
    step_frame(genuine);
    gnc::RangeImage frame = genuine;
    bool stands = false;
    for (int cycle = 1; cycle <= 6; ++cycle) {
      ++frame.sequence_number;
      frame.exposure_time_ns = next_time_ns();
      const bool lost = (cycle % 2 == 1) == starts_with_loss;
      lost ? step(StepInputs{}) : step_frame(frame);
      EXPECT_NE(validity(), Validity::kValid) << cycle;
      stands = stands || persists(Fault::kFrameFrozen);
    }
    EXPECT_TRUE(stands) << starts_with_loss;
    for (int cycle = 0; cycle < 20; ++cycle) step_good();
  }
}

// Corrupts the estimate between the estimator and the checks of the attitude, during the stopwatch call
// between them.
class UnsoundAttitudes : public DoubtfulAttitudes {
 protected:
  class Strike final : public hal::Stopwatch {
   public:
    std::uint64_t now_ns() override {
      if (++looks == at_look) strike();
      return 0;
    }
    std::function<void()> strike;
    int at_look = 0, looks = 0;
  };
  static constexpr int kBehindFrame = 2;  // readings: two around the estimator

  UnsoundAttitudes() {
    app->init({&strike, &store, &kTestKeys, nullptr, hal::ResetCause::kPowerOn}, kTestTarget);
  }
  gnc::AttitudeEstimate& estimate() { return AppMemory::estimate(*app); }
  void strike_next_step(int at_look, std::function<void()> what) {
    strike.strike = std::move(what);
    strike.at_look = at_look;
    strike.looks = 0;
  }
  Strike strike;
};

// Verifies TS-FDIR-090.
TEST_F(UnsoundAttitudes, NoneIsReportedWhicheverPartIsHit) {
  const std::function<void()> hits[] = {
      [this] {
        estimate().q_lrf_trf = {0, 0, 0, 0};
      },
      [this] {
        estimate().q_lrf_trf_single_frame = {INT32_MAX, 0, 0, 0};
      },
      [this] { estimate().predicted_error_urad = gnc::kPi_urad + 1; },
      [this] { estimate().predicted_error_single_frame_urad = UINT32_MAX; }};
  set_limit(Parameter::kPredictedError_urad, 3'141'593);
  unsigned scene = 1;
  for (const std::function<void()>& hit : hits) {
    strike_next_step(kBehindFrame, hit);
    step_scene(++scene);
    EXPECT_EQ(validity(), Validity::kFrameRefused);
    EXPECT_TRUE(persists(Fault::kAttitudeUnsound));
    EXPECT_EQ(argument(EventId::kEstimatorResetByFault, 0), static_cast<int>(Fault::kAttitudeUnsound));
    step_scene(++scene);
    EXPECT_EQ(validity(), Validity::kValid);
    EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  }
}

// Verifies TS-FDIR-060.
TEST_F(DoubtfulAttitudes, DisabledResponseReportsButDoesNotReset) {
  set_limit(Parameter::kPredictedError_urad, 3'141'593);
  set_limit(Parameter::kAttitudeJump_urad, 87'266);
  step_commands({command(FunctionCode::kDisableResponse, {static_cast<std::uint8_t>(Fault::kAttitudeJump)})});
  bool reported = false;
  for (unsigned i = 0; i < 40 && !reported; ++i) {
    step_scene(1000 + 7 * i);
    reported = persists(Fault::kAttitudeJump);
  }
  EXPECT_EQ(argument(EventId::kFaultPersists, 1), static_cast<int>(Response::kFlag));
  EXPECT_EQ(out->telemetry.estimator_resets, 1U);
}

}  // namespace
}  // namespace tumblesight::fsw
