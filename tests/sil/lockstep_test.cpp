#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <future>

#include "gnc/attitude/rotation.hpp"
#include "hal/posix/monitored_stack.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

using test::Conversation;

// Verifies TS-SIL-010.
TEST(Lockstep, EveryStepOfARunIsAnsweredWithAnAttitude) {
  std::uint32_t done = 0;
  // The attitudes of a random network would jump.
  const SilSettings settings = test::shipped_settings();
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(3, 1),
                                         [&](std::uint32_t answered, std::uint32_t planned) {
                                           EXPECT_EQ(planned, 30U);
                                           EXPECT_EQ(answered, ++done);
                                         });
  EXPECT_EQ(recording.failure, "");
  EXPECT_EQ(recording.steps_planned, 30U);
  EXPECT_EQ(recording.steps_missed, 0U);
  EXPECT_EQ(recording.flight_heap_allocations, 0U);
  EXPECT_EQ(done, 30U);
  ASSERT_EQ(recording.steps.size(), 30U);
  for (std::uint32_t k = 0; k < 30; ++k) {
    const StepResult& step = recording.steps[k];
    EXPECT_TRUE(step.answered);
    EXPECT_EQ(step.sequence, k / 10);
    EXPECT_TRUE(gives_attitude(step.attitude)) << "step " << k;
    EXPECT_EQ(step.attitude.sequence_number, k);
    EXPECT_EQ(step.attitude.time_ns, step.time_ns);
    EXPECT_EQ(step.attitude.exposure_time_ns, step.time_ns);
    EXPECT_EQ(step.attitude.frames_since_reset, k % 10 + 1)
        << "the estimator is reset at the start of every sequence";
    EXPECT_NEAR(gnc::to_double(step.attitude.q_lrf_trf).norm(), 1.0, 1e-6);
    EXPECT_EQ(step.telemetry.frames_used, k + 1);
  }
  EXPECT_EQ(recording.pictures.size(), 30U);
}

// Verifies TS-SIL-010.
TEST(Lockstep, FlightEndsWithTheLastStepAndLeavesNoProcess) {
  Conversation conversation(test::settings());
  const pid_t pid = conversation.session.flight_pid();
  EXPECT_EQ(test::flight_child(), pid);
  conversation.step();
  conversation.finish();
  EXPECT_EQ(test::flight_child(), 0);
}

// Verifies TS-SIL-010.
TEST(Lockstep, StepWaitsForAllSamplesItAnnounces) {
  Conversation conversation(test::settings());
  // Commands and frames of one step: four commands, then the frame is used by the same cycle.
  const StepAnswer answer = conversation.step({conversation.good_frame()},
                                              std::vector<Telecommand>(4, {hal::FunctionCode::kNoop, {}}));
  EXPECT_EQ(answer.telemetry.commands_accepted, 4U);
  EXPECT_EQ(answer.telemetry.frames_used, 1U);
  EXPECT_GE(answer.events.size(), 4U);
  EXPECT_EQ(conversation.finish().telemetry.cycles, 2U);
}

// Checks only that no step is early: how late a step is depends on the machine.
// Verifies TS-SIL-010.
TEST(Lockstep, NoStepIsEarlierThanTheSpeedAllows) {
  constexpr std::uint32_t kSteps = 6;
  const std::vector<Sequence> sequences{make_sequence({Condition::kNominal, kSteps}, 1, 0)};
  for (const double speed : {27.0, 13.5}) {
    SilSettings settings = test::settings();
    settings.speed = speed;
    const auto begin = std::chrono::steady_clock::now();
    std::uint32_t steps = 0;
    const SilRunResult recording =
        run_sil(settings, test::lidar(), test::kSwath_m, sequences, [&](std::uint32_t done, std::uint32_t) {
          const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
          EXPECT_GE(elapsed.count(), (done - 1) * kFramePeriod_s / speed) << "step " << done - 1;
          steps = done;
        });
    EXPECT_EQ(recording.failure, "");
    EXPECT_EQ(steps, kSteps);
  }
}

TEST(Lockstep, WithoutASpeedMissionTimeIsFasterThanTheWallClock) {
  const std::vector<Sequence> sequences{make_sequence({Condition::kNominal, 20}, 1, 0)};
  const auto begin = std::chrono::steady_clock::now();
  const SilRunResult recording = run_sil(test::settings(), test::lidar(), test::kSwath_m, sequences, {});
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(recording.failure, "");
  EXPECT_LT(elapsed.count(), 20 * kFramePeriod_s);
}

// Verifies TS-SIL-020.
TEST(Lockstep, ConcurrentRunsDoNotDisturbEachOther) {
  const auto run = [](std::uint64_t seed) {
    return run_sil(test::settings(), test::lidar(), test::kSwath_m, test::sequences(4, seed), {});
  };
  const SilRunResult alone = run(21);
  auto first = std::async(std::launch::async, run, 21);
  auto second = std::async(std::launch::async, run, 22);
  const SilRunResult a = first.get();
  const SilRunResult b = second.get();
  EXPECT_EQ(a.failure, "");
  EXPECT_EQ(b.failure, "");
  EXPECT_EQ(a.trace_crc32, alone.trace_crc32);
  EXPECT_NE(b.trace_crc32, alone.trace_crc32);
}

// Verifies TS-SIL-050.
TEST(Lockstep, DomainInUseIsRefused) {
  const DomainLease lease(-1);
  SilSettings settings = test::settings();
  settings.domain = static_cast<int>(lease.domain());
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  const std::string expected = "domain " + std::to_string(lease.domain()) + " is in use";
  EXPECT_NE(recording.failure.find(expected), std::string::npos) << recording.failure;
  EXPECT_EQ(recording.steps_missed, 10U);
}

TEST(Lockstep, FlightStartedByHandJoinsTheFirstRunItFinds) {
  SilSettings settings = test::settings();
  settings.domain = test::spare_domain();
  FlightProcess flight(settings.flight_path,
                       {"--domain", std::to_string(settings.domain), "--target", settings.target, "--model",
                        settings.model_path},
                       settings.flight_log_path);
  settings.flight_path.clear();
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_EQ(recording.failure, "");
  EXPECT_EQ(recording.steps_missed, 0U);
  EXPECT_TRUE(flight.wait_for_end(5.0));
  EXPECT_TRUE(flight.ended_well());
}

// Measures the time of a round trip without inference (mode SAFE). It does not check the time, which depends
// on the machine.
TEST(Lockstep, RoundTripWithoutInference) {
  SilSettings settings = test::settings();
  settings.target = "another_target";
  Conversation conversation(settings);
  constexpr int kSteps = 2000;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kSteps; ++i) conversation.step();
  const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - begin;
  const StepAnswer last = conversation.finish();
  EXPECT_EQ(last.telemetry.heap_allocations, 0U);
  std::printf("round trip without inference: %.0f us per step\n", elapsed.count() / kSteps);
}

// Verifies TS-MEM-020, TS-MEM-100.
// Inference, commands, events and refusals. The trap is armed on the flight task in all cycles.
TEST(Heap, TenThousandStepsWithoutAnAllocationOfTheFlightTask) {
  constexpr std::uint32_t kSteps = 10'500;
  test::Conversation conversation(test::settings());
  StepAnswer answer;
  for (std::uint32_t k = 0; k + 1 < kSteps; ++k) {
    gnc::RangeImage frame = conversation.good_frame();
    if (k % 97 == 0) frame.ranges.fill(0);
    std::vector<Telecommand> commands;
    if (k % 10 == 0) commands = {reset_sequence(), {hal::FunctionCode{199}, {}}};
    answer = conversation.step({frame}, commands);
    ASSERT_EQ(answer.telemetry.heap_allocations, 0U) << "step " << k;
  }
  answer = conversation.finish();
  EXPECT_EQ(answer.telemetry.cycles, kSteps);
  EXPECT_EQ(answer.telemetry.heap_allocations, 0U);
  EXPECT_GT(answer.telemetry.stack_left_min_bytes, hal::posix::MonitoredStack::kBytes / 4);
  EXPECT_LT(answer.telemetry.stack_left_min_bytes, hal::posix::MonitoredStack::kBytes);
  EXPECT_EQ(answer.telemetry.frames_bad, (kSteps - 2) / 97 + 1);
  EXPECT_EQ(answer.telemetry.frames_used, kSteps - answer.telemetry.frames_bad);
}

}  // namespace
}  // namespace tumblesight::sim
