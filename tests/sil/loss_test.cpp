#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "tests/sil/sil_test_support.hpp"

extern char** environ;

namespace tumblesight::sim {
namespace {

constexpr int kSimulatorGone = 4;  // exit statuses of flight
constexpr int kInterrupted = 130, kTerminated = 143;

// Runs five sequences and sends `signal` to flight after the seventh step.
SilRunResult run_with_signal(const SilSettings& settings, int signal) {
  return run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(5, 3),
                 [&](std::uint32_t done, std::uint32_t) {
                   if (done == 7) kill(test::flight_child(), signal);
                 });
}

void expect_partial(const SilRunResult& recording) {
  EXPECT_EQ(recording.steps_planned, 50U);
  EXPECT_GE(recording.steps.size(), 7U);
  EXPECT_GE(recording.steps_missed, 40U);
  EXPECT_LE(recording.steps_missed, 43U);
  EXPECT_TRUE(recording.steps[6].answered);
  EXPECT_EQ(test::flight_child(), 0);
}

// Verifies TS-SIL-040.
TEST(Loss, KilledFlightEndsTheRunAndKeepsItsResults) {
  const SilRunResult recording = run_with_signal(test::settings(), SIGKILL);
  EXPECT_NE(recording.failure.find("signal 9"), std::string::npos) << recording.failure;
  expect_partial(recording);
}

// Verifies TS-SIL-040.
TEST(Loss, FlightThatStopsAnsweringIsEnded) {
  SilSettings settings = test::settings();
  settings.step_timeout_s = 1.0;
  const SilRunResult recording = run_with_signal(settings, SIGSTOP);
  EXPECT_NE(recording.failure.find("did not answer step"), std::string::npos) << recording.failure;
  expect_partial(recording);
}

// Verifies TS-SIL-030.
TEST(Loss, FlightEndsCleanlyOnAStopRequest) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const SilSettings settings = test::settings();
    test::Conversation conversation(settings);
    conversation.step();
    const pid_t pid = conversation.session.flight_pid();
    kill(pid, signal);
    int status = -1;
    EXPECT_EQ(waitpid(pid, &status, 0), pid);
    const int expected = signal == SIGINT ? kInterrupted : kTerminated;
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == expected) << status;
    const char* const message = signal == SIGINT ? "flight: interrupted" : "flight: asked to stop";
    EXPECT_NE(test::read_file(settings.flight_log_path).find(message), std::string::npos);
  }
}

// Starts the simulator that will be killed, and returns when its flight program answers steps.
struct StartedSimulator {
  pid_t pid = 0;
  pid_t flight = 0;

  explicit StartedSimulator(const SilSettings& settings) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::string program = TUMBLESIGHT_SIMULATOR_TO_KILL;
    SilSettings copy = settings;
    std::string domain = std::to_string(settings.domain);
    char* argv[] = {program.data(),          copy.model_path.data(),
                    copy.flight_path.data(), copy.flight_log_path.data(),
                    domain.data(),           nullptr};
    posix_spawn(&pid, program.c_str(), &actions, nullptr, argv, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    char text[32] = {};
    if (read(ends[0], text, sizeof text - 1) > 0) flight = static_cast<pid_t>(std::atol(text));
    close(ends[0]);
  }
};

// Verifies TS-SIL-030.
TEST(Loss, KilledSimulatorEndsFlightWithAMessage) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);  // the orphaned flight program becomes a child of the test
  SilSettings settings = test::settings();
  settings.domain = test::spare_domain();
  const StartedSimulator simulator(settings);
  ASSERT_GT(simulator.flight, 0);
  kill(simulator.pid, SIGKILL);
  ASSERT_EQ(waitpid(simulator.pid, nullptr, 0), simulator.pid);
  EXPECT_THROW(DomainLease(settings.domain), SilFailure) << "flight still uses the domain";

  const auto begin = std::chrono::steady_clock::now();
  int status = -1;
  pid_t ended = 0;
  while (ended == 0 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(15)) {
    ended = waitpid(simulator.flight, &status, WNOHANG);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (ended == 0) kill(simulator.flight, SIGKILL);
  ASSERT_EQ(ended, simulator.flight) << "flight did not end by itself";
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == kSimulatorGone) << status;
  EXPECT_NE(test::read_file(settings.flight_log_path).find("simulator is gone"), std::string::npos);
  EXPECT_NO_THROW(DomainLease(settings.domain)) << "the domain is free again";
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::printf("flight ended %.1f s after the simulator was killed\n", took.count());
}

}  // namespace
}  // namespace tumblesight::sim
