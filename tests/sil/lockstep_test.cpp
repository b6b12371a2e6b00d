#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <future>

#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

using test::Conversation;

constexpr std::uint8_t kValid = 0;

double norm_of(const std::array<float, 4>& q) {
  return std::sqrt(double{q[0]} * q[0] + double{q[1]} * q[1] + double{q[2]} * q[2] + double{q[3]} * q[3]);
}

TEST(Lockstep, EveryStepOfARunIsAnsweredWithAnAttitude) {
  std::uint32_t done = 0;
  const SilRecording recording =
      run_sil(test::settings(), test::lidar(), test::kSwath_m, test::sequences(3, 1),
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
    const StepRecord& step = recording.steps[k];
    EXPECT_TRUE(step.answered);
    EXPECT_EQ(step.sequence, k / 10);
    EXPECT_EQ(step.attitude.validity, kValid) << "step " << k;
    EXPECT_EQ(step.attitude.sequence_number, k);
    EXPECT_EQ(step.attitude.time_ns, step.time_ns);
    EXPECT_EQ(step.attitude.exposure_time_ns, step.time_ns);
    EXPECT_EQ(step.attitude.frames_since_reset, k % 10 + 1)
        << "the estimator starts anew with every sequence";
    EXPECT_NEAR(norm_of(step.attitude.q_lrf_trf), 1.0, 1e-5);
    EXPECT_EQ(step.housekeeping.frames_used, k + 1);
  }
  EXPECT_EQ(recording.pictures.size(), 30U);
}

TEST(Lockstep, TheFlightProgramEndsWithTheLastStepAndLeavesNothingBehind) {
  Conversation conversation(test::settings());
  const pid_t pid = conversation.session.flight_pid();
  EXPECT_EQ(test::flight_child(), pid);
  conversation.step();
  conversation.finish();
  EXPECT_EQ(test::flight_child(), 0);
}

TEST(Lockstep, AStepWaitsForEverythingThatItAnnounces) {
  Conversation conversation(test::settings());
  // Commands and frames of one step: four commands, then the frame is used by the same cycle.
  const StepAnswer answer =
      conversation.step({conversation.good_frame()}, std::vector<hal::Command>(4, test::command(1)));
  EXPECT_EQ(answer.housekeeping.commands_accepted, 4U);
  EXPECT_EQ(answer.housekeeping.frames_used, 1U);
  EXPECT_GE(answer.events.size(), 4U);
  EXPECT_EQ(conversation.finish().housekeeping.cycles, 2U);
}

TEST(Lockstep, SpeedOneIsRealTimeAndFasterIsFaster) {
  SilSettings settings = test::settings();
  settings.speed = 27.0;  // a period in 100 ms
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Sequence> sequences{make_sequence(Condition::kNominal, 1, 0, 6)};
  const SilRecording recording = run_sil(settings, test::lidar(), test::kSwath_m, sequences, {});
  EXPECT_EQ(recording.failure, "");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
}

TEST(Lockstep, RunsAtTheSameTimeDoNotDisturbEachOther) {
  const auto run = [](std::uint64_t seed) {
    return run_sil(test::settings(), test::lidar(), test::kSwath_m, test::sequences(4, seed), {});
  };
  const SilRecording alone = run(21);
  auto first = std::async(std::launch::async, run, 21);
  auto second = std::async(std::launch::async, run, 22);
  const SilRecording a = first.get();
  const SilRecording b = second.get();
  EXPECT_EQ(a.failure, "");
  EXPECT_EQ(b.failure, "");
  EXPECT_EQ(a.trace_crc32, alone.trace_crc32);
  EXPECT_NE(b.trace_crc32, alone.trace_crc32);
}

TEST(Lockstep, ADomainInUseIsRefused) {
  SilSettings settings = test::settings();
  settings.domain = 199;
  Conversation conversation(settings);
  const SilRecording recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(recording.failure.find("domain 199 is in use"), std::string::npos) << recording.failure;
  EXPECT_EQ(recording.steps_missed, 10U);
  conversation.finish();
}

TEST(Lockstep, FlightStartedByHandTakesPartInTheFirstRunThatShowsUp) {
  SilSettings settings = test::settings();
  settings.domain = 198;
  FlightProcess flight(settings.flight_path,
                       {"--domain", "198", "--target", settings.target, "--model", settings.model_path},
                       settings.flight_log_path);
  settings.flight_path.clear();
  const SilRecording recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_EQ(recording.failure, "");
  EXPECT_EQ(recording.steps_missed, 0U);
  EXPECT_TRUE(flight.wait_for_end(5.0));
  EXPECT_TRUE(flight.ended_well());
}

// Not a check of speed, which depends on the machine, but the place where it is measured: no inference in
// STANDBY.
TEST(Lockstep, RoundTripWithoutInference) {
  SilSettings settings = test::settings();
  settings.flight_arguments = {"--target", "another_target"};
  Conversation conversation(settings);
  constexpr int kSteps = 2000;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kSteps; ++i) conversation.step();
  const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - begin;
  const StepAnswer last = conversation.finish();
  EXPECT_EQ(last.housekeeping.heap_allocations, 0U);
  std::printf("round trip without inference: %.0f us a step\n", elapsed.count() / kSteps);
}

}  // namespace
}  // namespace tumblesight::sim
