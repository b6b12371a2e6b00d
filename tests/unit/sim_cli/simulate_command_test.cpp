// `tumblesight simulate` as a user runs it, flight program and DDS included.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/sim_cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

TEST(Simulate, RefusesArgumentsOutOfRange) {
  const Workplace here;
  const std::pair<const char*, const char*> refusals[] = {
      {"--speed fast", "must be max or a number from 0.1 to 1000, not 'fast'"},
      {"--speed 0", "not '0'"},
      {"--domain 231", "from 0 to 230"},
      {"--sequences 1e3", "from 1 to 100000"},
      {"--report /proc/none/report.html", "--report /proc/none/report.html"},
  };
  for (const auto& [arguments, message] : refusals) {
    const Outcome outcome = here.run(std::string("simulate ") + arguments);
    EXPECT_NE(outcome.exit_code, 0) << arguments;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << outcome.errors;
  }
}

TEST(Simulate, RefusesAMissingFlightProgram) {
  const Workplace here;
  const Outcome outcome =
      here.run("simulate --flight /no/flight --report " + here.path("r.html") + " --model " + here.model());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("'/no/flight' does not exist"), std::string::npos) << outcome.errors;
}

TEST(Simulate, LeavesFiguresAndAReport) {
  const Workplace here;
  const Outcome outcome = here.run("simulate --sequences 2 --frames 3 --seed 4 --model " + here.model() +
                                   " --json " + here.path("run.json") + " --report " + here.path("run.html"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(content(here.path("run.json")));
  EXPECT_EQ(json.at("steps_missed"), 0);
  EXPECT_EQ(json.at("flight_heap_allocations"), 0);
  EXPECT_NE(content(here.path("run.html")).find("</html>"), std::string::npos);
  EXPECT_NE(outcome.output.find("6 of 6 answered"), std::string::npos) << outcome.output;
}

TEST(Simulate, AgreesWithEvaluateOnTheSameSeed) {
  const Workplace here;
  const std::string common = " --sequences 2 --frames 3 --seed 4 --model " + here.model() + " --json ";
  ASSERT_EQ(here.run("simulate --report " + here.path("r.html") + common + here.path("sil.json")).exit_code,
            0);
  ASSERT_EQ(here.run("evaluate" + common + here.path("direct.json")).exit_code, 0);
  const auto sil = nlohmann::json::parse(content(here.path("sil.json")));
  const auto direct = nlohmann::json::parse(content(here.path("direct.json"))).at("rows").at(0);
  EXPECT_EQ(sil.at("rcnn"), direct.at("rcnn"));
  EXPECT_EQ(sil.at("cnn"), direct.at("cnn"));
}

TEST(Simulate, FailsWhenTheFlightProgramRefusesTheModel) {
  const Workplace here;
  const Outcome outcome = here.run("simulate --sequences 1 --frames 2 --model " + here.model("magellan") +
                                   " --report " + here.path("r.html"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("STANDBY"), std::string::npos) << outcome.errors;
  EXPECT_NE(content(here.path("r.html")).find("STANDBY"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
