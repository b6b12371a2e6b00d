// A foreign program on the bus forges samples of a topic. The run is undisturbed, or it ends with a failure
// that names what was seen; it never ends well with other results.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <ostream>
#include <thread>

#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

struct Forgery {
  const char* target;
  const char* topic;  // that a failure names; nullptr: nothing reads the topic, so the run is undisturbed
  // Of two programs that announce themselves as the simulator, flight cannot know which one is foreign.
  bool names_attacker = true;
};

// The name of a case in messages: GoogleTest would print addresses.
void PrintTo(const Forgery& forgery, std::ostream* out) {
  *out << forgery.target;
}

// Of a test case: letters only.
std::string name_of(const Forgery& forgery) {
  std::string name;
  for (const char* c = forgery.target; *c != '\0'; ++c) {
    if (*c != '-') name += *c;
  }
  return name;
}

struct Knowledge {
  const char* run_id;
  const char* k;
  const char* begin_k;
};

// An attacker that listens in `domain`, until the end of this object.
class Attacker {
 public:
  Attacker(int domain, const char* target, const Knowledge& knows)
      : log_(test::temporary_path("attacker.log")),
        process_(TUMBLESIGHT_BUS_ATTACKER,
                 {std::to_string(domain), target, knows.run_id, knows.k, knows.begin_k}, log_) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (test::read_file(log_) != "ready\n" && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(test::read_file(log_), "ready\n");
  }
  bool running() { return process_.running(); }
  std::string process() const { return "process " + std::to_string(process_.pid()); }

 private:
  std::string log_;
  FlightProcess process_;
};

// Lasts about a second, so that an attacker that begins in it is found before the end.
SilRunResult short_run(int domain, const std::string& security_path = {}) {
  SilSettings settings = test::settings();
  settings.domain = domain;
  settings.security_path = security_path;
  settings.speed = 54.0;
  settings.step_timeout_s = 5.0;
  static const std::vector<Sequence> sequences{make_sequence({Condition::kNominal, 20}, 31, 0)};
  return run_sil(settings, test::lidar(), test::kSwath_m, sequences, {});
}

std::uint32_t undisturbed_trace() {
  static const std::uint32_t trace = [] {
    const SilRunResult run = short_run(-1);
    EXPECT_EQ(run.failure, "");
    return run.trace_crc32;
  }();
  return trace;
}

class Attack : public ::testing::TestWithParam<Forgery> {};

// Verifies TS-SIL-090.
TEST_P(Attack, EndsTheRunWithWhatWasSeenOrLeavesItUndisturbed) {
  const Forgery& forgery = GetParam();
  const std::uint32_t undisturbed = undisturbed_trace();
  const int domain = test::spare_domain();
  int ended = 0;
  for (const Knowledge& knows :
       {Knowledge{"guessed", "guessed", "0"}, Knowledge{"observed", "observed", "0"},
        Knowledge{"guessed", "guessed", "3"}, Knowledge{"observed", "guessed", "3"},
        Knowledge{"guessed", "observed", "3"}, Knowledge{"observed", "observed", "3"}}) {
    SCOPED_TRACE(std::string(knows.run_id) + " run id, " + knows.k + " step, from step " + knows.begin_k);
    Attacker attacker(domain, forgery.target, knows);
    const SilRunResult run = short_run(domain);
    EXPECT_TRUE(attacker.running()) << "the attacker ended early";
    EXPECT_EQ(test::flight_child(), 0);
    if (run.failure.empty()) {
      EXPECT_EQ(run.trace_crc32, undisturbed);
      EXPECT_EQ(run.steps_missed, 0U);
      continue;
    }
    ++ended;
    ASSERT_NE(forgery.topic, nullptr) << run.failure;
    EXPECT_NE(run.failure.find(forgery.topic), std::string::npos) << run.failure;
    if (!forgery.names_attacker) continue;
    EXPECT_NE(run.failure.find(attacker.process()), std::string::npos) << run.failure;
  }
  EXPECT_EQ(ended > 0, forgery.topic != nullptr);
}

INSTANTIATE_TEST_SUITE_P(
    Sil, Attack,
    ::testing::Values(Forgery{"hello-of-simulator", "sil/hello", false}, Forgery{"hello-of-flight", ""},
                      Forgery{"frame", "sil/lidar_frame"}, Forgery{"navigation", "sil/navigation"},
                      Forgery{"command", "sil/command"}, Forgery{"step", "sil/step"},
                      Forgery{"attitude", "sil/attitude"}, Forgery{"telemetry", "sil/telemetry"},
                      Forgery{"event", "sil/event"}, Forgery{"dump", "sil/memory_dump"},
                      Forgery{"step-done", "sil/step_done"}, Forgery{"truth", nullptr}),
    [](const auto& test) { return name_of(test.param); });

// Verifies TS-SIL-097.
TEST(Attack, ASecuredBusIsUndisturbed) {
  const std::string folder = test::temporary_path("security");
  const std::string command =
      std::string("'" TUMBLESIGHT_MAKE_SECURITY "' '") + folder + "' > /dev/null 2>&1";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "openssl or the plug-ins of Cyclone DDS are not installed";
  ASSERT_EQ(WEXITSTATUS(status), 0);
  const std::uint32_t undisturbed = undisturbed_trace();
  const int domain = test::spare_domain();
  for (const char* const target : {"step", "hello-of-simulator", "step-done"}) {
    Attacker attacker(domain, target, {"observed", "observed", "0"});
    const SilRunResult run = short_run(domain, folder + "/security.xml");
    EXPECT_EQ(run.failure, "") << target;
    EXPECT_EQ(run.trace_crc32, undisturbed) << target;
    EXPECT_TRUE(attacker.running());
  }
}

// The program that a user runs, with the network that ships.
class AttackOnSimulate : public ::testing::TestWithParam<Forgery> {
 protected:
  static constexpr int kSuccess = 0, kFailure = 1;
  struct Ended {
    int status = -1;
    std::string message;
    nlohmann::json figures;
  };

  static Ended simulate(int domain) {
    const std::string log = test::temporary_path("simulate.log"), json = test::temporary_path("run.json");
    FlightProcess program(
        TUMBLESIGHT_PROGRAM,
        {"simulate", "--sequences", "2", "--speed", "54", "--domain", std::to_string(domain), "--json", json,
         "--report", test::temporary_path("report.html")},
        log);
    EXPECT_TRUE(program.wait_for_end(60.0));
    const bool failed = program.how_it_ended().find("exit status 1:") != std::string::npos;
    return {program.ended_well() ? kSuccess
            : failed             ? kFailure
                                 : -1,
            test::read_file(log), nlohmann::json::parse(test::read_file(json), nullptr, false)};
  }
};

// Verifies TS-SIL-090.
TEST_P(AttackOnSimulate, EndsWithAFailureThatNamesTheTopicAndTheProcess) {
  const int domain = test::spare_domain();
  static const nlohmann::json undisturbed = simulate(domain).figures;
  EXPECT_EQ(undisturbed.at("rcnn").at("within_20deg"), 1.0);
  Attacker attacker(domain, GetParam().target, {"observed", "observed", "3"});
  const Ended ended = simulate(domain);
  EXPECT_EQ(ended.status, kFailure) << ended.message;
  EXPECT_NE(ended.message.find(GetParam().topic), std::string::npos) << ended.message;
  EXPECT_NE(ended.message.find(attacker.process()), std::string::npos) << ended.message;
  EXPECT_TRUE(attacker.running());
}

INSTANTIATE_TEST_SUITE_P(Sil, AttackOnSimulate,
                         ::testing::Values(Forgery{"step", "sil/step is also written by"},
                                           Forgery{"frame", "sil/lidar_frame is also written by"},
                                           Forgery{"attitude", "sil/attitude is also written by"},
                                           Forgery{"step-done", "sil/step_done is also written by"}),
                         [](const auto& test) { return name_of(test.param); });

}  // namespace
}  // namespace tumblesight::sim
