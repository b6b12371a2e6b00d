// The digest of the state, and the content of the telemetry.
// Verifies TS-TLM-010, TS-TLM-020.
#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class Telemetry : public AppFixture {
 protected:
  Telemetry() : twin(std::make_unique<AttitudeInitApp>()), twin_out(std::make_unique<StepOutputs>()) {
    init_with_model();
    boot(*twin, {&stopwatch, &store, &kTestKeys, nullptr, hal::ResetCause::kPowerOn});
  }
  std::unique_ptr<AttitudeInitApp> twin;
  std::unique_ptr<StepOutputs> twin_out;
};

TEST_F(Telemetry, StateDigestDependsOnTheActiveModel) {
  hal::fake::FakeModelStore other;
  other.fill(gnc::lasting_model_image<gnc::FixedPoint>(8));
  boot(*twin, {&stopwatch, &other, &kTestKeys, nullptr, hal::ResetCause::kPowerOn});
  ASSERT_EQ(twin->mode(), Mode::kRun);
  EXPECT_NE(app->state_crc32(), twin->state_crc32());
}

TEST_F(Telemetry, StateDigestDependsOnWhatIsKeptBetweenFrames) {
  using Change = void (*)(AppState&);
  for (const Change change : {
           Change([](AppState& state) { (void)state.authority.use(1); }),
           Change([](AppState& state) { state.tracking.has_jumped = true; }),
           Change([](AppState& state) { state.tracking.has_chaser_attitude = true; }),
           Change([](AppState& state) { state.tracking.q_inertial_lrf[3] = 1; }),
           Change([](AppState& state) { state.tracking.has_found_rate = true; }),
           Change([](AppState& state) { state.tracking.history.add({1}); }),
           Change([](AppState& state) { state.frames_unused = 1; }),
           Change([](AppState& state) { state.counters.frames_repeated = 1; }),
           Change([](AppState& state) { state.counters.frames_without_chaser = 1; }),
           Change([](AppState& state) { state.counters.frames_superseded = 1; }),
           Change([](AppState& state) { state.counters.frames_overflowed = 1; }),
           Change([](AppState& state) { state.counters.frames_passed_over = 1; }),
       }) {
    hal::CommandKeys keys = kTestKeys;
    keys.slots[1] = keys.slots[0];
    for (AttitudeInitApp* which : {app.get(), twin.get()})
      boot(*which, {&stopwatch, &store, &keys, nullptr, hal::ResetCause::kPowerOn});
    EXPECT_EQ(app->state_crc32(), twin->state_crc32());
    change(AppMemory::state(*twin));
    EXPECT_NE(app->state_crc32(), twin->state_crc32());
  }
}

TEST_F(Telemetry, StateDigestDependsOnModeEstimatorAndCounters) {
  EXPECT_EQ(app->state_crc32(), twin->state_crc32());
  step_good();
  EXPECT_NE(app->state_crc32(), twin->state_crc32());
  const gnc::RangeImage frame = good_frame(sequence_number, now_ns, sequence_number - 1);
  StepInputs inputs;
  inputs.frame = &frame;
  twin->step(now_ns, inputs, *twin_out);
  EXPECT_EQ(app->state_crc32(), twin->state_crc32());
  step_commands({command(FunctionCode::kNoop)});
  twin->step(now_ns, StepInputs{}, *twin_out);
  EXPECT_NE(app->state_crc32(), twin->state_crc32()) << "a command was counted";
}

// Verifies TS-TLM-040.
TEST_F(Telemetry, EventsBeyondTheLimitOfAStepWaitForTheNextOne) {
  for (std::size_t block = 0; block < 8; ++block)
    store.banks[1].memory[block * config::kModelBlockBytes + 9] ^= 1;
  StepInputs inputs;
  inputs.command_count = config::kMaxCommandsPerStep;
  for (hal::CommandPacket& packet : inputs.commands) packet = command(FunctionCode::kNoop);
  inputs.cycle_slips = 1;
  step(inputs);
  EXPECT_EQ(out->event_count, config::kMaxEventsPerStep);
  EXPECT_EQ(out->telemetry.events_waiting, 3U) << "activated, 8 repaired, 8 accepted, slipped, no frame: 19";
  now_ns = next_time_ns();
  app->step(now_ns, StepInputs{}, *out);
  EXPECT_EQ(out->event_count, 3);
  EXPECT_EQ(out->telemetry.events_waiting, 0U);
}

// Verifies TS-TLM-040.
TEST_F(Telemetry, EventsAreSentWaitingSuppressedOrLost) {
  hal::CommandPacket forged = command(FunctionCode::kNoop);
  forged.bytes[0] ^= 1;
  StepInputs inputs;
  inputs.command_count = config::kMaxCommandsPerStep;
  for (hal::CommandPacket& packet : inputs.commands) packet = forged;
  inputs.cycle_slips = 1;
  inputs.frame_wrong_size = 2;
  int sent = 0;
  for (int cycle = 0; cycle < 40; ++cycle) {
    step(inputs);
    sent += out->event_count;
    EXPECT_LE(out->event_count, config::kMaxEventsPerStep);
    const hal::Telemetry& h = out->telemetry;
    EXPECT_EQ(h.events,
              static_cast<std::uint32_t>(sent) + h.events_waiting + h.events_suppressed + h.events_lost);
    EXPECT_GE(h.events_waiting_max, h.events_waiting);
  }
  EXPECT_GT(out->telemetry.events_suppressed, 0U);
  EXPECT_EQ(out->telemetry.commands_refused, 40U * config::kMaxCommandsPerStep);
}

}  // namespace
}  // namespace tumblesight::fsw
