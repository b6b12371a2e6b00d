#include <string>

#include "tests/unit/fsw_app/app_fixture.hpp"
#include "tests/unit/gnc_rcnn/test_models.hpp"

namespace tumblesight::fsw {
namespace {

// A stopwatch of a faulty platform: as a frame is about to be used, it fills the place for events, so that
// the next event fails an assertion in the middle of the cycle.
class SpoilingStopwatch final : public hal::Stopwatch {
 public:
  explicit SpoilingStopwatch(StepOutputs& outputs) : outputs_(outputs) {}
  std::uint64_t now_ns() override {
    if (armed && ++calls_ == 2) outputs_.event_count = config::kMaxEventsPerStep;
    return 0;
  }
  bool armed = false;

 private:
  StepOutputs& outputs_;
  int calls_ = 0;
};

class ModesAndCommands : public AppFixture {
 protected:
  // A platform that breaks the limits of StepInputs: a bug, hence an assertion.
  const StepOutputs& step_with_bug() {
    StepInputs inputs;
    inputs.command_count = config::kMaxCommandsPerStep + 1;
    return step(inputs);
  }
};

TEST_F(ModesAndCommands, GoodModelLeadsToEstimatingWithAnEvent) {
  EXPECT_EQ(app->mode(), Mode::kStandby);
  init_with_model();
  EXPECT_EQ(app->mode(), Mode::kEstimating);
  EXPECT_EQ(app->model_status(), gnc::ModelStatus::kOk);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  ASSERT_NE(event(EventId::kModelActivated), nullptr);
  EXPECT_EQ(argument(EventId::kModelActivated, 0), static_cast<std::int32_t>(gnc::kModelImageSize<gnc::FixedPoint>));
  step_good();
  EXPECT_EQ(event(EventId::kModelActivated), nullptr) << "once only";
}

TEST_F(ModesAndCommands, RefusedModelLeavesStandbyAndSaysWhichError) {
  std::vector<std::uint8_t> spoilt = test_model_image();
  spoilt[0] ^= 1;
  app->init(spoilt.data(), spoilt.size(), kTestTarget, stopwatch);
  EXPECT_EQ(app->model_status(), gnc::ModelStatus::kBadMagic);
  step_good();
  ASSERT_NE(event(EventId::kModelRefused), nullptr);
  EXPECT_EQ(argument(EventId::kModelRefused, 0), static_cast<int>(gnc::ModelStatus::kBadMagic));
  EXPECT_EQ(event(EventId::kModelRefused)->severity, static_cast<int>(Severity::kError));
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->housekeeping.mode, static_cast<int>(Mode::kStandby));
  step_commands({command(Opcode::kEstimate)});
  ASSERT_NE(event(EventId::kCommandRefused), nullptr);
  EXPECT_EQ(argument(EventId::kCommandRefused, 2), static_cast<int>(CommandRefusal::kNoModel));
  EXPECT_EQ(app->mode(), Mode::kStandby);
}

TEST_F(ModesAndCommands, MissingModelOrAnotherTargetLeavesStandby) {
  app->init(nullptr, 0, kTestTarget, stopwatch);
  EXPECT_EQ(app->model_status(), gnc::ModelStatus::kTooShort);
  EXPECT_EQ(app->mode(), Mode::kStandby);
  app->init(test_model_image().data(), test_model_image().size(), "another_craft", stopwatch);
  EXPECT_EQ(app->model_status(), gnc::ModelStatus::kBadTarget);
  EXPECT_EQ(app->mode(), Mode::kStandby);
}

TEST_F(ModesAndCommands, RefusedSecondModelLeavesTheFirstAtWork) {
  init_with_model();
  step_good();
  const std::uint32_t crc = estimator_crc();
  app->init(nullptr, 0, kTestTarget, stopwatch);
  EXPECT_EQ(app->mode(), Mode::kEstimating);
  EXPECT_EQ(estimator_crc(), crc);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 2U);
  EXPECT_EQ(events(EventId::kModelRefused), 1);
  init_with_model();
  step_good();
  EXPECT_EQ(out->attitude.frames_since_reset, 1U) << "activation resets the estimator";
}

TEST_F(ModesAndCommands, NoopIsAcceptedAndChangesNothing) {
  init_with_model();
  step_good();
  const std::uint32_t crc = estimator_crc();
  step_commands({command(Opcode::kNoop)});
  EXPECT_EQ(out->housekeeping.commands_accepted, 1U);
  EXPECT_EQ(events(EventId::kCommandAccepted), 1);
  EXPECT_EQ(app->mode(), Mode::kEstimating);
  EXPECT_EQ(estimator_crc(), crc);
}

TEST_F(ModesAndCommands, UnknownOpcodesAndPayloadsAreRefusedCountedAndReported) {
  init_with_model();
  hal::Command unknown;
  unknown.opcode = 6;
  hal::Command zero;
  hal::Command long_standby = command(Opcode::kStandby);
  long_standby.payload_size = 1;
  step_commands({unknown, zero, long_standby, command(Opcode::kNoop)});
  EXPECT_EQ(out->housekeeping.commands_refused, 3U);
  EXPECT_EQ(out->housekeeping.commands_accepted, 1U);
  EXPECT_EQ(events(EventId::kCommandRefused), 3);
  EXPECT_EQ(argument(EventId::kCommandRefused, 0), 6);
  EXPECT_EQ(argument(EventId::kCommandRefused, 2), static_cast<int>(CommandRefusal::kUnknownOpcode));
  EXPECT_EQ(app->mode(), Mode::kEstimating);
  step_commands({long_standby});
  EXPECT_EQ(argument(EventId::kCommandRefused, 1), 1);
  EXPECT_EQ(argument(EventId::kCommandRefused, 2), static_cast<int>(CommandRefusal::kWrongLength));
}

TEST_F(ModesAndCommands, StandbyGivesNoAttitudeAndEstimateStartsAnew) {
  init_with_model();
  step_good();
  step_good();
  step_commands({command(Opcode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kStandby);
  EXPECT_EQ(out->housekeeping.frames_missing, 0U) << "nobody waits for frames in STANDBY";
  step_good();
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->housekeeping.frames_used, 2U);

  // A new session of the sensor may number from anywhere, even the number last used.
  StepInputs inputs;
  inputs.commands[0] = command(Opcode::kEstimate);
  inputs.command_count = 1;
  const gnc::RangeImage frame = good_frame(102, next_time_ns());
  inputs.frame = &frame;
  step(inputs);
  ASSERT_NE(event(EventId::kCommandAccepted), nullptr);
  EXPECT_EQ(argument(EventId::kCommandAccepted, 1), static_cast<int>(Mode::kStandby));
  EXPECT_EQ(argument(EventId::kCommandAccepted, 2), static_cast<int>(Mode::kEstimating));
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  EXPECT_EQ(out->housekeeping.sequence_gaps, 0U);
}

TEST_F(ModesAndCommands, EstimateWhileEstimatingHasNoEffect) {
  init_with_model();
  step_good();
  const std::uint32_t crc = estimator_crc();
  step_commands({command(Opcode::kEstimate)});
  EXPECT_EQ(out->housekeeping.commands_accepted, 1U);
  EXPECT_EQ(estimator_crc(), crc);
  EXPECT_EQ(out->housekeeping.estimator_resets, 1U) << "only the one of init()";
}

TEST_F(ModesAndCommands, ResetEstimatorStartsASequenceYetRemembersTheLastFrame) {
  init_with_model();
  step_good();
  const gnc::RangeImage used = next_frame();
  step_good();
  EXPECT_EQ(out->attitude.frames_since_reset, 2U);

  StepInputs inputs;
  inputs.commands[0] = command(Opcode::kResetEstimator);
  inputs.command_count = 1;
  inputs.frame = &used;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kFrameRefused) << "the frame has been used before the reset";
  EXPECT_EQ(out->housekeeping.frames_duplicate, 1U);
  EXPECT_EQ(out->housekeeping.estimator_resets, 2U);
  step_good();
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  EXPECT_EQ(events(EventId::kEstimatorResetByGap), 0) << "a new sequence has no gap behind it";
}

TEST_F(ModesAndCommands, SequenceAfterResetEqualsTheFirstSequenceBitForBit) {
  init_with_model();
  std::array<gnc::QuaternionQ30, 2> last{};
  std::array<std::uint32_t, 2> crc{};
  for (std::size_t run = 0; run < 2; ++run) {
    for (unsigned i = 0; i < 3; ++i) {
      StepInputs inputs;
      inputs.commands[0] = command(Opcode::kResetEstimator);
      inputs.command_count = i == 0 ? 1 : 0;
      const gnc::RangeImage frame = good_frame(++sequence_number, next_time_ns(), i);
      inputs.frame = &frame;
      step(inputs);
      EXPECT_EQ(out->attitude.frames_since_reset, i + 1);
    }
    last[run] = out->attitude.q_lrf_trf;
    crc[run] = estimator_crc();
  }
  EXPECT_EQ(last[0], last[1]);
  EXPECT_EQ(crc[0], crc[1]);
  EXPECT_EQ(out->housekeeping.sequence_gaps, 0U);
}

TEST_F(ModesAndCommands, ResetCountersZeroesAllButItself) {
  init_with_model();
  stopwatch.tick_ns = 5'000;
  step_good();
  step_commands({command(Opcode::kNoop)});
  EXPECT_GT(out->housekeeping.inference_max_us, 0U);
  step_commands({command(Opcode::kResetCounters)});
  EXPECT_EQ(out->housekeeping.commands_accepted, 1U);
  EXPECT_EQ(out->housekeeping.frames_used, 0U);
  EXPECT_EQ(out->housekeeping.inference_max_us, 0U);
  EXPECT_EQ(out->housekeeping.estimator_resets, 0U);
  EXPECT_EQ(app->mode(), Mode::kEstimating);
}

TEST_F(ModesAndCommands, CommandsAreCarriedOutInOrderBeforeTheFrame) {
  init_with_model();
  step_good();
  StepInputs inputs;
  inputs.commands[0] = command(Opcode::kEstimate);
  inputs.commands[1] = command(Opcode::kStandby);
  inputs.command_count = 2;
  const gnc::RangeImage frame = next_frame();
  inputs.frame = &frame;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->housekeeping.frames_used, 1U);
}

TEST_F(ModesAndCommands, AssertionGoesSafeUntilStandbyIsCommanded) {
  init_with_model();
  step_good();
  step_with_bug();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  ASSERT_NE(event(EventId::kAssertion), nullptr);
  EXPECT_EQ(static_cast<std::uint32_t>(argument(EventId::kAssertion, 0)), file_id("attitude_init_app.cpp"));
  EXPECT_GT(argument(EventId::kAssertion, 1), 0);
  step_good();
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(events(EventId::kAssertion), 0);
  step_commands({command(Opcode::kEstimate)});
  ASSERT_NE(event(EventId::kCommandRefused), nullptr);
  EXPECT_EQ(argument(EventId::kCommandRefused, 2), static_cast<int>(CommandRefusal::kSafe));
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_commands({command(Opcode::kStandby), command(Opcode::kEstimate)});
  EXPECT_EQ(app->mode(), Mode::kEstimating);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
}

TEST_F(ModesAndCommands, NoAttitudeLeavesTheCycleThatAnAssertionEnds) {
  SpoilingStopwatch spoiling(*out);
  app->init(test_model_image().data(), test_model_image().size(), kTestTarget, spoiling);
  step_good();
  step_good();
  // The numbers skipped are an event of the first frame; the second is as good.
  sequence_number += 5;
  std::array<gnc::RangeImage, 2> frames{next_frame(), next_frame()};
  frames[0].exposure_time_ns -= 1'000'000;
  frames[1].sequence_number += 1;
  StepInputs inputs;
  inputs.frame = frames.data();
  inputs.frame_count = 2;
  spoiling.armed = true;
  app->step(next_time_ns(), inputs, *out);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(out->housekeeping.mode, static_cast<int>(Mode::kSafe));
  EXPECT_EQ(out->housekeeping.frames_used, 3U) << "the second frame is not touched";
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->attitude.time_ns, next_time_ns());
  EXPECT_EQ(out->attitude.frames_since_reset, 0U);
  EXPECT_EQ(out->attitude.sequence_number, 0U);
  EXPECT_EQ(out->attitude.q_lrf_trf, gnc::kIdentityQ30);
  EXPECT_EQ(out->attitude.predicted_error_urad, gnc::kPi_urad);
}

TEST_F(ModesAndCommands, NewModelDoesNotEndSafe) {
  init_with_model();
  step_good();
  step_with_bug();
  init_with_model();
  EXPECT_EQ(app->mode(), Mode::kSafe);
}

TEST_F(ModesAndCommands, StepBeforeInitIsABugOfTheCaller) {
  step_good();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(events(EventId::kAssertion), 1);
  EXPECT_EQ(validity(), Validity::kStandby);
}

TEST(Assertion, KeepsTheFirstFailureAndCountsAll) {
  AssertionLog log;
  EXPECT_TRUE(TUMBLESIGHT_ASSERT(log, 1 + 1 == 2));
  EXPECT_FALSE(log.take());
  EXPECT_FALSE(log.record(file_id("folder/one.cpp"), 10));
  EXPECT_FALSE(log.record(file_id("two.cpp"), 20));
  EXPECT_TRUE(log.take());
  EXPECT_FALSE(log.take());
  EXPECT_EQ(log.file(), file_id("/another/folder/one.cpp"));
  EXPECT_EQ(log.line(), 10);
  EXPECT_EQ(log.count(), 2U);
}

TEST_F(ModesAndCommands, InferenceTimeGoesToHousekeepingAndNowhereElse) {
  init_with_model();
  stopwatch.tick_ns = 4'000;
  step_good();
  EXPECT_EQ(out->housekeeping.inference_us, 4U);
  EXPECT_EQ(out->housekeeping.deadline_overruns, 0U);
  const std::uint32_t crc_fast = app->state_crc32();

  auto slow = std::make_unique<FixedPointApp>();
  hal::fake::FakeStopwatch slow_stopwatch;
  slow_stopwatch.tick_ns = static_cast<std::uint64_t>(config::kStepBudget_ns);
  slow->init(test_model_image().data(), test_model_image().size(), kTestTarget, slow_stopwatch);
  const gnc::RangeImage frame = good_frame(sequence_number, now_ns, sequence_number - 1);
  StepInputs inputs;
  inputs.frame = &frame;
  slow->step(now_ns, inputs, *out);
  EXPECT_EQ(out->housekeeping.deadline_overruns, 1U);
  EXPECT_EQ(out->housekeeping.inference_max_us, config::kStepBudget_ns / 1000);
  EXPECT_EQ(slow->state_crc32(), crc_fast);
  EXPECT_EQ(out->event_count, 1) << "the model's; a late step must not change the telemetry's digest";
}

TEST_F(ModesAndCommands, StopwatchRunningBackwardsMeasuresNothing) {
  init_with_model();
  stopwatch.time_ns = 1'000'000'000;
  stopwatch.tick_ns = std::uint64_t{0} - 1'000'000;
  step_good();
  EXPECT_EQ(out->housekeeping.inference_us, 0U);
  EXPECT_EQ(out->housekeeping.deadline_overruns, 0U);
}

TEST_F(ModesAndCommands, StateDigestTellsWhichModelIsActive) {
  const std::vector<std::uint8_t>& other = gnc::lasting_model_image<gnc::FixedPoint>(8);
  init_with_model();
  auto twin = std::make_unique<FixedPointApp>();
  twin->init(other.data(), other.size(), kTestTarget, stopwatch);
  ASSERT_EQ(twin->model_status(), gnc::ModelStatus::kOk);
  EXPECT_NE(app->state_crc32(), twin->state_crc32());
}

TEST_F(ModesAndCommands, StateDigestFollowsModeEstimatorAndCounters) {
  init_with_model();
  auto twin = std::make_unique<FixedPointApp>();
  twin->init(test_model_image().data(), test_model_image().size(), kTestTarget, stopwatch);
  auto twin_out = std::make_unique<StepOutputs>();
  EXPECT_EQ(app->state_crc32(), twin->state_crc32());
  step_good();
  EXPECT_NE(app->state_crc32(), twin->state_crc32());
  const gnc::RangeImage frame = good_frame(sequence_number, now_ns, sequence_number - 1);
  StepInputs inputs;
  inputs.frame = &frame;
  twin->step(now_ns, inputs, *twin_out);
  EXPECT_EQ(app->state_crc32(), twin->state_crc32());
  step_commands({command(Opcode::kNoop)});
  twin->step(now_ns, StepInputs{}, *twin_out);
  EXPECT_NE(app->state_crc32(), twin->state_crc32()) << "a command was counted";
}

}  // namespace
}  // namespace tumblesight::fsw
