// The effect of each command and of each refusal. Commands for models: model_commands_test.cpp.
#include <string>

#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class Commands : public AppFixture {
 protected:
  Commands() { init_with_model(); }
  // Inputs beyond the limits of StepInputs, which are a bug of the platform and fail an assertion.
  const StepOutputs& step_with_bug() {
    StepInputs inputs;
    inputs.command_count = config::kMaxCommandsPerStep + 1;
    return step(inputs);
  }
  std::uint32_t refused_by(CommandRefusal why) const {
    return out->telemetry.commands_refused_by[static_cast<std::size_t>(why)];
  }
};

// Verifies TS-CMD-100.
TEST_F(Commands, NoopIsAcceptedAndChangesNothing) {
  step_good();
  const std::uint32_t crc = estimator_crc();
  step_commands({command(FunctionCode::kNoop)});
  EXPECT_EQ(out->telemetry.commands_accepted, 1U);
  EXPECT_EQ(events(EventId::kCommandAccepted), 1);
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(estimator_crc(), crc);
}

// Verifies TS-CMD-030.
TEST_F(Commands, EveryRefusalHasItsOwnEventAndCounter) {
  std::vector<std::uint8_t> malformed = packet_of(1), misfit = packet_of(1), unsound = packet_of(1);
  malformed[2] = 0x40;
  misfit[5] = 9;
  unsound[7] ^= 1;
  hal::CommandPacket forged = command(FunctionCode::kNoop);
  forged.bytes[0] ^= 1;
  const hal::CommandPacket old = signed_with(kTestKey, 0, packet_of(1));
  const auto signed_next = [this](const std::vector<std::uint8_t>& packet) {
    return signed_with(kTestKey, ++command_counter, packet);
  };
  step_commands({forged, old, signed_next(malformed), signed_next(misfit), signed_next(unsound),
                 signed_next(packet_of(99)), command(FunctionCode::kModelActivate, {0, 0, 0, 0}),
                 command(FunctionCode::kSetMode, {0})});
  const CommandRefusal expected[] = {CommandRefusal::kForged,        CommandRefusal::kReplayed,
                                     CommandRefusal::kMalformed,     CommandRefusal::kWrongLength,
                                     CommandRefusal::kWrongChecksum, CommandRefusal::kUnknownFunction,
                                     CommandRefusal::kWrongMode,     CommandRefusal::kWrongArgument};
  for (const CommandRefusal why : expected) {
    EXPECT_EQ(refused_by(why), 1U) << static_cast<int>(why);
    EXPECT_EQ(events(event_of(why)), 1) << static_cast<int>(why);
  }
  EXPECT_EQ(out->telemetry.commands_refused, 8U);
  EXPECT_EQ(out->telemetry.commands_accepted, 0U);
  EXPECT_EQ(out->telemetry.command_counter, command_counter);
  EXPECT_EQ(argument(EventId::kCommandUnknown, 0), 99);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-SEC-030.
TEST_F(Commands, RecordedCommandSentAgainIsRefused) {
  const hal::CommandPacket standby = set_mode(Mode::kStandby);
  step_commands({standby});
  step_commands({set_mode(Mode::kRun)});
  step_commands({standby});
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
}

// Verifies TS-SEC-030.
TEST_F(Commands, RefusedAuthenticCommandCannotBeReplayedInAnotherMode) {
  const hal::CommandPacket activate = command(FunctionCode::kModelActivate, {0, 0, 0, 0});
  step_commands({activate});
  EXPECT_EQ(refused_by(CommandRefusal::kWrongMode), 1U);
  step_commands({set_mode(Mode::kStandby), activate});
  EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
}

// Verifies TS-CMD-120, TS-MODE-040.
TEST_F(Commands, StandbyGivesNoAttitudeAndRunStartsANewSequence) {
  step_good();
  step_good();
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kStandby);
  EXPECT_EQ(out->telemetry.frames_missing, 0U) << "no frames are expected in STANDBY";
  step_good();
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->telemetry.frames_used, 2U);

  // A restarted sensor may begin with any sequence number, even the last used one.
  StepInputs inputs;
  inputs.commands[0] = set_mode(Mode::kRun);
  inputs.command_count = 1;
  const gnc::RangeImage frame = good_frame(102, next_time_ns());
  inputs.frame = &frame;
  step(inputs);
  EXPECT_EQ(argument(EventId::kCommandAccepted, 1), static_cast<int>(Mode::kStandby));
  EXPECT_EQ(argument(EventId::kCommandAccepted, 2), static_cast<int>(Mode::kRun));
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  EXPECT_EQ(out->telemetry.sequence_gaps, 0U);
}

// Verifies TS-CMD-120.
TEST_F(Commands, RunInRunHasNoEffect) {
  step_good();
  const std::uint32_t crc = estimator_crc();
  step_commands({set_mode(Mode::kRun)});
  EXPECT_EQ(out->telemetry.commands_accepted, 1U);
  EXPECT_EQ(estimator_crc(), crc);
  EXPECT_EQ(out->telemetry.estimator_resets, 1U) << "only the reset by init()";
}

// Verifies TS-MODE-040, TS-MODE-050.
TEST_F(Commands, OnlyEnteringRunResetsAndOnlyEnteringSafeSetsTheCause) {
  step_good();
  const std::uint32_t crc = estimator_crc();
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kStandby)});
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kNone);
  step_with_bug();
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kAssertion) << "the cause of the first change to SAFE";
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(out->telemetry.estimator_resets, 1U) << "only the reset by init()";
  EXPECT_EQ(estimator_crc(), crc);
  step_commands({set_mode(Mode::kRun)});
  EXPECT_EQ(out->telemetry.estimator_resets, 2U);
}

// Verifies TS-CMD-120.
TEST_F(Commands, BootAndUnknownModesCannotBeCommanded) {
  for (const std::uint8_t mode : {std::uint8_t{0}, std::uint8_t{4}, std::uint8_t{255}}) {
    step_commands({command(FunctionCode::kSetMode, {mode})});
    EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
    EXPECT_EQ(app->mode(), Mode::kRun);
  }
}

// Verifies TS-MODE-050.
TEST_F(Commands, SafeIsLeftForStandbyOnly) {
  step_commands({set_mode(Mode::kSafe)});
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_EQ(out->telemetry.safe_cause, Cause::kCommandSafe);
  step_good();
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->telemetry.mode, Mode::kSafe) << "telemetry continues";
  step_commands({set_mode(Mode::kRun)});
  EXPECT_EQ(refused_by(CommandRefusal::kWrongMode), 1U);
  EXPECT_EQ(app->mode(), Mode::kSafe);
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun)});
  EXPECT_EQ(app->mode(), Mode::kRun);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
}

// Verifies TS-CMD-130.
TEST_F(Commands, ResetSequenceStartsASequenceButKeepsTheLastFrame) {
  step_good();
  const gnc::RangeImage used = next_frame();
  step_good();
  EXPECT_EQ(out->attitude.frames_since_reset, 2U);

  StepInputs inputs;
  inputs.commands[0] = command(FunctionCode::kResetSequence);
  inputs.command_count = 1;
  inputs.frame = &used;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kFrameRefused) << "the frame was used before the reset";
  EXPECT_EQ(out->telemetry.frames_duplicate, 1U);
  EXPECT_EQ(out->telemetry.estimator_resets, 2U);
  step_good();
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  EXPECT_EQ(events(EventId::kEstimatorResetByGap), 0) << "a new sequence has no gap before it";
}

// Verifies TS-CMD-130.
TEST_F(Commands, SequenceAfterResetEqualsTheFirstSequenceBitForBit) {
  std::array<gnc::QuaternionQ30, 2> last{};
  std::array<std::uint32_t, 2> crc{};
  constexpr unsigned kFrames =
      gnc::FrameHistory::kFrames + 1;  // otherwise the second sequence is a repetition
  for (std::size_t run = 0; run < 2; ++run) {
    for (unsigned i = 0; i < kFrames; ++i) {
      StepInputs inputs;
      inputs.command_count = i == 0 ? 1 : 0;
      if (i == 0) inputs.commands[0] = command(FunctionCode::kResetSequence);
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
  EXPECT_EQ(out->telemetry.sequence_gaps, 0U);
}

// Verifies TS-CMD-110.
TEST_F(Commands, ResetCountersKeepsOnlyItselfAndTheCommandCounter) {
  stopwatch.tick_ns = 5'000;
  step_good();
  const hal::CommandPacket noop = command(FunctionCode::kNoop);
  step_commands({noop});
  EXPECT_GT(out->telemetry.inference_max_us, 0U);
  step_commands({command(FunctionCode::kResetCounters)});
  EXPECT_EQ(out->telemetry.commands_accepted, 1U);
  EXPECT_EQ(out->telemetry.frames_used, 0U);
  EXPECT_EQ(out->telemetry.inference_max_us, 0U);
  EXPECT_EQ(out->telemetry.estimator_resets, 0U);
  EXPECT_EQ(out->telemetry.command_counter, command_counter);
  EXPECT_EQ(app->mode(), Mode::kRun);
  step_commands({noop});
  EXPECT_EQ(refused_by(CommandRefusal::kReplayed), 1U);
}

// Verifies TS-TLM-040.
TEST_F(Commands, WaitingEventsAreCountedAgainAfterACounterReset) {
  step_good();
  StepInputs inputs;
  inputs.command_count = config::kMaxCommandsPerStep;
  for (hal::CommandPacket& one : inputs.commands) one = command(FunctionCode::kNoop);
  inputs.commands.back() = command(FunctionCode::kResetCounters);
  step(inputs);
  EXPECT_GE(out->event_count, config::kMaxCommandsPerStep);
  EXPECT_EQ(out->telemetry.events, static_cast<std::uint32_t>(out->event_count))
      << "all of them are sent after the reset";
}

// Verifies TS-CMD-040.
TEST_F(Commands, CommandsAreCarriedOutInOrderBeforeTheFrame) {
  step_good();
  StepInputs inputs;
  inputs.commands[0] = set_mode(Mode::kRun);
  inputs.commands[1] = set_mode(Mode::kStandby);
  inputs.command_count = 2;
  const gnc::RangeImage frame = next_frame();
  inputs.frame = &frame;
  step(inputs);
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(out->telemetry.frames_used, 1U);
}

// Verifies TS-CMD-150.
TEST_F(Commands, ResponsesAreDisabledAndEnabledExceptMandatoryOnes) {
  const auto fault = static_cast<std::uint8_t>(Fault::kAttitudeJump);
  step_commands({command(FunctionCode::kDisableResponse, {fault})});
  EXPECT_EQ(out->telemetry.responses_disabled, bit_of(Fault::kAttitudeJump));
  step_commands({command(FunctionCode::kEnableResponse, {fault})});
  EXPECT_EQ(out->telemetry.responses_disabled, 0U);
  step_commands(
      {command(FunctionCode::kDisableResponse, {static_cast<std::uint8_t>(Fault::kModelCorrupted)})});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  step_commands({command(FunctionCode::kEnableResponse, {kFaults})});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
}

TEST_F(Commands, InputsBeyondALimitAreABugOfTheCaller) {
  struct Row {
    int commands, dropped, wrong_size;
    bool bug;
  };
  const gnc::RangeImage frame = next_frame();
  for (const Row& row : {Row{8, 31, 0, false}, Row{0, 0, 31, false}, Row{0, 1, 1, false}, Row{-1, 0, 0, true},
                         Row{9, 0, 0, true}, Row{0, -1, 0, true}, Row{0, 33, 0, true}, Row{0, 0, -1, true},
                         Row{0, 0, 33, true}, Row{0, 16, 16, true}}) {
    StepInputs inputs;
    inputs.command_count = row.commands;
    inputs.frame = &frame;
    inputs.dropped_count = row.dropped;
    inputs.frame_wrong_size = row.wrong_size;
    init_with_model();
    step(inputs);
    EXPECT_EQ(events(EventId::kAssertion), row.bug ? 1 : 0)
        << row.commands << ' ' << row.dropped << ' ' << row.wrong_size;
    EXPECT_EQ(out->duties_done, !row.bug);
  }
}

// Verifies TS-MODE-060.
TEST_F(Commands, AssertionLeadsToSafeUntilStandbyIsCommanded) {
  step_good();
  step_with_bug();
  EXPECT_EQ(app->mode(), Mode::kSafe);
  EXPECT_FALSE(out->duties_done);
  ASSERT_NE(event(EventId::kAssertion), nullptr);
  EXPECT_EQ(static_cast<std::uint32_t>(argument(EventId::kAssertion, 0)), file_id("attitude_init_app.cpp"));
  EXPECT_GT(argument(EventId::kAssertion, 1), 0);
  step_good();
  EXPECT_EQ(validity(), Validity::kStandby);
  EXPECT_EQ(events(EventId::kAssertion), 0);
  step_commands({set_mode(Mode::kStandby), set_mode(Mode::kRun)});
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
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

}  // namespace
}  // namespace tumblesight::fsw
