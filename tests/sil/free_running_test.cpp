#include <gtest/gtest.h>

#include <cmath>

#include "fsw/config/parameters.hpp"
#include "gnc/attitude/quaternion.hpp"
#include "sim/sil/simulated_steps.hpp"
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

// Verifies TS-TIM-070, TS-TIM-130.
// Nothing here is faster than in flight: a busy machine has half a period to spare.
TEST(FreeRunning, AtThePeriodOfFlightEveryReportIsOnTime) {
  SilSettings settings = test::shipped_settings();
  settings.free_running = true;
  settings.speed = 1.0;
  const std::vector<Sequence> sequences{make_sequence({Condition::kNominal, 8}, 1, 0)};
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, sequences, {});
  EXPECT_EQ(run.failure, "");
  EXPECT_EQ(run.steps_missed, 0U);
  ASSERT_EQ(run.steps.size(), 8U);
  const hal::Telemetry& telemetry = run.steps.back().telemetry;
  EXPECT_GT(telemetry.cycle_max_us, 100U);
  EXPECT_LT(telemetry.cycle_max_us, 1'350'000U);
  EXPECT_EQ(telemetry.deadline_overruns, 0U);
  EXPECT_EQ(telemetry.registrations_cut_short, 0U);
  EXPECT_EQ(telemetry.cycle_slips, 0U);
  EXPECT_EQ(telemetry.heap_allocations, 0U);
  EXPECT_EQ(run.steps.back().attitude.pose_doubts, 0) << "verified";
}

// The steps of another source, with a telecommand in the first one.
class WithTelecommand final : public StepSource {
 public:
  WithTelecommand(StepSource& source, const Telecommand& command) : source_(source), command_(command) {}
  std::uint32_t steps() const override { return source_.steps(); }
  std::int64_t time_ns(std::uint32_t k) const override { return source_.time_ns(k); }
  SourcedStep next() override {
    SourcedStep step = source_.next();
    if (count_++ == 0) step.input.commands.push_back(command_);
    return step;
  }

 private:
  StepSource& source_;
  Telecommand command_;
  int count_ = 0;
};
Telecommand set_cycle_budget(std::uint32_t budget_us) {
  const auto byte = [budget_us](int shift) { return static_cast<std::uint8_t>(budget_us >> shift); };
  return {hal::FunctionCode::kSetParameter,
          {static_cast<std::uint8_t>(fsw::Parameter::kCycleBudget_us), byte(24), byte(16), byte(8), byte(0)}};
}

// A processor on which the registration of a frame takes half a second and more.
class SlowProcessor : public testing::Test {
 protected:
  SilRunResult run(const SilSettings& settings, std::uint32_t budget_us) {
    const test::Environment preload("LD_PRELOAD", TUMBLESIGHT_FAULT_IN_FLIGHT);
    const test::Environment fault("TUMBLESIGHT_FAULT", "slow");
    const std::vector<Sequence> sequences = test::sequences(1, 1);
    SimulatedSteps simulated(test::lidar(), test::kSwath_m, sequences, false);
    WithTelecommand source(simulated, set_cycle_budget(budget_us));
    return run_sil(settings, source, {});
  }
};

// Verifies TS-TIM-130.
TEST_F(SlowProcessor, FreeRunningCutsItsRegistrationShortAndReportsOnTime) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer must be loaded before any other library";
#endif
  SilSettings settings = test::shipped_settings();
  settings.free_running = true;
  settings.speed = 5.4;  // a period of 500 ms
  const SilRunResult result = run(settings, 200'000);
  EXPECT_EQ(result.failure, "");
  EXPECT_LE(result.steps_missed, 1U) << "a busy machine may lose a cycle";
  constexpr double k20Degrees_rad = 20.0 * M_PI / 180.0;
  std::uint32_t events = 0;
  for (const StepResult& step : result.steps) {
    if (!step.answered || step.frame_index == 0) continue;
    EXPECT_NE(step.attitude.pose_doubts, 0) << "not verified";
    EXPECT_LT(gnc::to_double(step.attitude.q_lrf_trf).angularDistance(step.truth.q_lrf_trf), k20Degrees_rad);
    for (const hal::Event& event : step.events)
      events += event.id == hal::EventId::kRegistrationCutShort ? 1 : 0;
  }
  const hal::Telemetry& last = result.steps.back().telemetry;
  EXPECT_GE(last.registrations_cut_short, 8U);
  EXPECT_GE(events, 6U);
  EXPECT_LE(last.cycle_slips, 1U) << "without the deadline most cycles slip";
  EXPECT_EQ(result.flight_heap_allocations, 0U);
}

// Verifies TS-TIM-130.
TEST_F(SlowProcessor, InLockstepGivesTheResultsOfAFastOne) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer must be loaded before any other library";
#endif
  const SilRunResult result = run(test::shipped_settings(), 1'000);
  EXPECT_EQ(result.failure, "");
  ASSERT_EQ(result.steps.size(), 10U);
  EXPECT_GT(result.steps.back().telemetry.deadline_overruns, 5U);
  EXPECT_EQ(result.steps.back().telemetry.registrations_cut_short, 0U);
  EXPECT_EQ(result.steps.back().attitude.pose_doubts, 0) << "verified";
}

TEST(FreeRunning, NeedsASpeed) {
  SilSettings settings = test::settings();
  settings.free_running = true;
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(recording.failure.find("needs a speed"), std::string::npos) << recording.failure;
}

}  // namespace
}  // namespace tumblesight::sim
