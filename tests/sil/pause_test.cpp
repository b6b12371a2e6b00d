// A pause of a program, as Ctrl-Z, a debugger or a frozen container makes it, ends no run in lockstep.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <initializer_list>
#include <optional>
#include <thread>

#include "hal/dds/idl/topics.hpp"
#include "sim/host/child_process.hpp"
#include "sim/sil/flight_process.hpp"
#include "sim/sil/run_announcement.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;

// Longer than the 3 s after which a short lease of DDS would give up a program.
constexpr auto kPause = 4500ms;

void pause(std::initializer_list<pid_t> processes) {
  for (const pid_t process : processes) ASSERT_EQ(kill(process, SIGSTOP), 0);
  std::this_thread::sleep_for(kPause);
  for (const pid_t process : processes) ASSERT_EQ(kill(process, SIGCONT), 0);
}

void expect_goes_on(test::Conversation& conversation) {
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t k = conversation.k;
    EXPECT_EQ(conversation.step().k, k);
  }
  EXPECT_EQ(conversation.finish().telemetry.heap_allocations, 0U);
}

// Verifies TS-SIL-010.
TEST(Pause, OfFlightBetweenStepsEndsNoRun) {
  test::Conversation conversation(test::settings());
  conversation.step();
  pause({conversation.session.flight_pid()});
  expect_goes_on(conversation);
}

// Verifies TS-SIL-010.
TEST(Pause, OfFlightWithinAStepEndsNoRun) {
  test::Conversation conversation(test::settings());
  conversation.step();
  std::thread pausing([&] { pause({conversation.session.flight_pid()}); });
  std::this_thread::sleep_for(50ms);
  conversation.step();
  pausing.join();
  expect_goes_on(conversation);
}

// A simulator of 40 steps with its flight program, in a process group of their own as a shell starts it.
class Simulation {
 public:
  Simulation()
      : process_(TUMBLESIGHT_SIMULATOR_TO_KILL,
                 {test::model_path(), TUMBLESIGHT_FLIGHT, log_, std::to_string(test::spare_domain()), "40"},
                 messages_, -1, {}, output_, ProcessGroup::kOwn) {}
  pid_t pid() const { return process_.pid(); }
  // It tells the flight program when that has answered the first step.
  void wait_for_first_step() {
    for (int i = 0; i < 1000 && test::read_file(output_).empty(); ++i) std::this_thread::sleep_for(10ms);
    ASSERT_NE(test::read_file(output_), "") << test::read_file(messages_);
  }
  void expect_complete() {
    EXPECT_TRUE(process_.wait_for_end(20.0));
    EXPECT_TRUE(process_.ended_well()) << process_.how_it_ended() << test::read_file(messages_);
  }

 private:
  std::string log_ = test::temporary_path("flight.log");
  std::string messages_ = test::temporary_path("simulator.log"), output_ = test::temporary_path("output");
  ChildProcess process_;
};

// Ctrl-Z stops the whole group.
// Verifies TS-SIL-010.
TEST(Pause, OfBothEndsNoRun) {
  Simulation simulation;
  simulation.wait_for_first_step();
  pause({-simulation.pid()});
  simulation.expect_complete();
}

// Verifies TS-SIL-010.
TEST(Pause, OfTheSimulatorEndsNoRun) {
  Simulation simulation;
  simulation.wait_for_first_step();
  pause({simulation.pid()});
  simulation.expect_complete();
}

// A program that reads the frames of the run in a domain, and tells when it sees the simulator.
[[noreturn]] void read_frames(int domain, int seen) {
  std::optional<AnnouncedRun> run;
  while (!(run = announced_run(domain))) std::this_thread::sleep_for(10ms);
  hal::dds::Domain bus;
  if (bus.open(run->domain, run->secret.partition) != 0) _exit(1);
  const dds_entity_t reader = hal::dds::create_reader(bus, hal::dds::topic_of<hal::dds::LidarFrameSample>());
  while (dds_get_matched_publications(reader, nullptr, 0) <= 0) std::this_thread::sleep_for(10ms);
  (void)!write(seen, "y", 1);
  for (;;) ::pause();
}

// As the console. The simulator does not wait for it: 60 frames are four times what it keeps for a reader.
TEST(Pause, OfAProgramThatOnlyReadsDelaysNoRun) {
  SilSettings settings = test::settings();
  settings.domain = test::spare_domain();
  int seen[2];
  ASSERT_EQ(pipe(seen), 0);
  const pid_t reader = fork();
  if (reader == 0) read_frames(settings.domain, seen[1]);
  test::Conversation conversation(settings);
  char answer = 0;
  EXPECT_EQ(read(seen[0], &answer, 1), 1);
  EXPECT_EQ(kill(reader, SIGSTOP), 0);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_NO_THROW({
    for (int i = 0; i < 60; ++i) conversation.step();
    conversation.finish();
  });
  std::printf("60 steps beside a paused reader: %.1f s\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  kill(reader, SIGKILL);
  waitpid(reader, nullptr, 0);
  for (const int end : seen) close(end);
}

// It misses releases, which it counts.
TEST(Pause, OfAFlightProgramThatRunsFreelyIsCounted) {
  SilSettings settings = test::shipped_settings();
  settings.free_running = true;
  settings.speed = 10.0;
  std::thread pausing;
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(3, 1),
                                   [&](std::uint32_t done, std::uint32_t) {
                                     if (done == 3)
                                       pausing = std::thread([] { pause({test::flight_child()}); });
                                   });
  if (pausing.joinable()) pausing.join();
  EXPECT_EQ(run.failure, "");
  EXPECT_GT(run.steps_missed + run.frames_superseded, 0U);
  EXPECT_NE(test::read_file(settings.flight_log_path).find("releases of the flight task slipped"),
            std::string::npos);
}

// A flight program that the user has started is no child of the simulator.
struct ByHand {
  SilSettings settings = test::settings();
  FlightProcess flight;
  ByHand()
      : settings(with_domain()),
        flight(settings.flight_path,
               {"--domain", std::to_string(settings.domain), "--target", settings.target, "--model",
                settings.model_path},
               settings.flight_log_path) {
    settings.flight_path.clear();
  }
  static SilSettings with_domain() {
    SilSettings result = test::settings();
    result.domain = test::spare_domain();
    return result;
  }
};

// Verifies TS-SIL-010.
TEST(Pause, OfAFlightProgramOfTheUserEndsNoRun) {
  ByHand by_hand;
  test::Conversation conversation(by_hand.settings);
  conversation.step();
  pause({by_hand.flight.pid()});
  expect_goes_on(conversation);
}

// Verifies TS-SIL-040.
TEST(Pause, IsToldFromTheDeathOfAFlightProgramOfTheUser) {
  ByHand by_hand;
  test::Conversation conversation(by_hand.settings);
  conversation.step();
  kill(by_hand.flight.pid(), SIGKILL);
  const auto begin = std::chrono::steady_clock::now();
  try {
    conversation.step();
    ADD_FAILURE() << "the flight program is dead";
  } catch (const SilFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("the flight program has ended at step 1"), std::string::npos)
        << failure.what();
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
}

}  // namespace
}  // namespace tumblesight::sim
