// `tumblesight simulate` as a user runs it, flight program and DDS included.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <future>
#include <nlohmann/json.hpp>
#include <thread>

#include "sim/world/sensor/sensor_description.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

// False if the condition is still false after half a minute.
bool wait_for(const std::function<bool()>& condition) {
  for (int i = 0; i < 600; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST(Simulate, RefusesArgumentsOutOfRange) {
  const Workplace here;
  const std::pair<const char*, const char*> refusals[] = {
      {"--speed fast", "must be max or a number from 0.1 to 1000, not 'fast'"},
      {"--speed 0", "not '0'"},
      {"--free-running", "--free-running: needs a speed: --speed 1 for real time"},
      {"--period 0.1 --period-jitter 0.9",
       "--period 0.1 with --period-jitter 0.9 has frames 0.01 s apart; the flight program refuses frames "
       "less "
       "than 0.1 s apart: give at least --period 1, or a smaller --period-jitter"},
      {"--frozen 2 --lost-frames 2", "--frozen 2 has no effect: every frozen frame is lost"},
      {"--domain 231", "from 0 to 230"},
      {"--domain 010", "without leading zeros, not '010'"},
      {"--sequences 100000 --frames 1000", "100000000 frames in all; a run has at most 1000000"},
      {"--json x --report x", "--json: 'x' is also the file of --report"},
      {"--json x --report ../$(basename $PWD)/./x", "is also the file of --report"},
      {"--sequences 1e3", "from 1 to 100000"},
      {"--report /proc/none/report.html", "--report /proc/none/report.html"},
  };
  for (const auto& [arguments, message] : refusals) {
    const Outcome outcome = here.run(std::string("simulate ") + arguments);
    EXPECT_NE(outcome.exit_code, 0) << arguments;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << outcome.errors;
  }
}

// Verifies TS-SIL-040.
TEST(Simulate, RefusesAMissingFlightProgram) {
  const Workplace here;
  const Outcome outcome =
      here.run("simulate --flight /no/flight --report " + here.path("r.html") + " --model " + here.model());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("'/no/flight' does not exist"), std::string::npos) << outcome.errors;
}

TEST(Simulate, RefusesAFlightProgramThatCannotBeStarted) {
  const Workplace here;
  const std::string model = here.model();
  const Outcome outcome = here.run("simulate --flight model.tsm --report r.html --model " + model);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.output, "") << "it began";
  EXPECT_NE(outcome.errors.find("flight program 'model.tsm' cannot be started: Permission denied; give an "
                                "executable one with --flight"),
            std::string::npos)
      << outcome.errors;
}

TEST(Simulate, LeavesFiguresAndAReport) {
  const Workplace here;
  const Outcome outcome = here.run("simulate --sequences 2 --frames 3 --seed 4 --model " + here.model() +
                                   " --json " + here.path("run.json") + " --report " + here.path("run.html"));
  ASSERT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  const auto json = nlohmann::json::parse(content(here.path("run.json")));
  EXPECT_EQ(json.at("steps_missed"), 0);
  EXPECT_EQ(json.at("flight_heap_allocations"), 0);
  EXPECT_NE(content(here.path("run.html")).find("</html>"), std::string::npos);
  EXPECT_NE(outcome.output.find("6 of 6 answered"), std::string::npos) << outcome.output;
}

// Tumbling, because both need the inertia of the target for it. A sensor with a period of its own.
// Verifies TS-SIL-060.
TEST(Simulate, AgreesWithEvaluateOnTheSameSeed) {
  const Workplace here;
  SensorDescription own;
  own.period_s = 1.5;
  std::ofstream(here.path("own.json")) << to_json(own);
  const std::string common =
      " --condition tumbling --sequences 2 --frames 3 --seed 4 --sensor own.json --model " + here.model() +
      " --json ";
  ASSERT_EQ(here.run("simulate --report " + here.path("r.html") + common + here.path("sil.json")).exit_code,
            kGuessed);
  ASSERT_EQ(here.run("evaluate --no-baseline" + common + here.path("direct.json")).exit_code, kGuessed);
  const auto sil = nlohmann::json::parse(content(here.path("sil.json")));
  const auto direct = nlohmann::json::parse(content(here.path("direct.json"))).at("rows").at(0);
  EXPECT_EQ(sil.at("rcnn"), direct.at("rcnn"));
  EXPECT_EQ(sil.at("cnn"), direct.at("cnn"));
  EXPECT_EQ(sil.at("disturbances").at("period"), 1.5);
  EXPECT_EQ(sil.at("disturbances"), direct.at("disturbances"));
}

// Verifies TS-SIL-380. Random weights, so that the attitudes are guesses.
TEST(Simulate, SaysThatTheAttitudesAreMostlyWrongAndFailsWithAStatusOfItsOwn) {
  const Workplace here;
  const std::string common = "simulate --sequences 6 --frames 2 --report r.html --model " + here.model();
  const Outcome outcome = here.run(common);
  EXPECT_EQ(outcome.exit_code, kOfNoUse) << outcome.errors;
  EXPECT_NE(outcome.output.find(" % of the attitudes are more than 20° off"), std::string::npos)
      << outcome.output;
  EXPECT_NE(content(here.path("r.html")).find("does not know the attitude of NEAR Shoemaker"),
            std::string::npos);
  EXPECT_EQ(here.run(common + " --effect sphere=1").exit_code, 0);
  const Outcome right = here.run("simulate --sequences 3 --report r.html");
  EXPECT_EQ(right.exit_code, 0) << right.errors;
  EXPECT_EQ(right.output.find("more than 20° off"), std::string::npos) << right.output;
}

// Verifies TS-SIL-390.
TEST(Simulate, GivesTheErrorsOfEvaluateModuloTheSymmetryOfTheTarget) {
  const Workplace here;
  const std::string common =
      " --sequences 2 --frames 2 --symmetry z:4 --symmetry 1,0,0:2 --model " + here.model() + " --json ";
  (void)here.run("simulate --report r.html" + common + "sil.json");
  (void)here.run("evaluate --no-baseline" + common + "direct.json");
  const auto sil = nlohmann::json::parse(content(here.path("sil.json")));
  const auto direct = nlohmann::json::parse(content(here.path("direct.json"))).at("rows").at(0);
  EXPECT_EQ(sil.at("symmetry"), "1/4 turn about z, 1/2 turn about x");
  for (const char* key : {"symmetry", "rcnn", "cnn", "pose", "pose_first"})
    EXPECT_EQ(sil.at(key), direct.at(key)) << key;
}

TEST(Simulate, FailsWhenTheFlightProgramRefusesTheModel) {
  const Workplace here;
  const std::string other = here.put("other.tsm", arbitrary_model("magellan", 7000));
  const std::string flight =
      here.script("flight.sh", std::string("exec ") + FLIGHT_BINARY + " \"$@\" --model " + other);
  const Outcome outcome = here.run("simulate --sequences 1 --frames 2 --model " + here.model() +
                                   " --flight " + flight + " --report " + here.path("r.html"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("SAFE"), std::string::npos) << outcome.errors;
  EXPECT_NE(content(here.path("r.html")).find("SAFE"), std::string::npos);
}

TEST(Simulate, RefusesAModelImageAsEvaluateDoes) {
  const Workplace here;
  const std::string damaged = here.path("damaged.tsm");
  std::string bytes = content(here.model());
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(damaged, std::ios::binary) << bytes;
  const std::string foreign = here.put("foreign.tsm", arbitrary_model("magellan", 7000));
  for (const std::string& image : {damaged, foreign}) {
    const Outcome simulated = here.run("simulate --sequences 1 --frames 2 --report r.html --model " + image);
    const Outcome evaluated = here.run("evaluate --sequences 1 --frames 2 --model " + image);
    EXPECT_EQ(simulated.exit_code, 1);
    EXPECT_NE(simulated.errors.find("is refused: "), std::string::npos) << simulated.errors;
    EXPECT_EQ(simulated.errors, evaluated.errors);
  }
}

// Verifies TS-SIL-110.
TEST(Simulate, CarriesOnWithAFlightProgramThatKeepsItsState) {
  const Workplace here;
  const std::string flight = here.script(
      "flight.sh", std::string("exec ") + FLIGHT_BINARY + " \"$@\" --state " + here.path("state"));
  const std::string arguments = "simulate --sequences 3 --frames 2 --model " + here.model() + " --flight " +
                                flight + " --report r.html --json ";
  for (const char* const figures : {"first.json", "second.json"}) {
    const Outcome outcome = here.run(arguments + figures);
    EXPECT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  }
  const auto first = nlohmann::json::parse(content(here.path("first.json")));
  const auto second = nlohmann::json::parse(content(here.path("second.json")));
  EXPECT_EQ(first.at("rcnn"), second.at("rcnn")) << "every sequence was reset in both runs";
}

// Verifies TS-TIM-080.
TEST(Simulate, SaysHowManyFramesOfAFastSensorWereSuperseded) {
  const Workplace here;
  const Outcome outcome = here.run(
      "simulate --free-running --speed 5.4 --period 1 --sequences 1 --frames 12 --json "
      "run.json --report r.html");
  EXPECT_NE(outcome.output.find("superseded by a newer frame of the same cycle"), std::string::npos)
      << outcome.output << outcome.errors;
  EXPECT_EQ(outcome.output.find("float32 reference"), std::string::npos) << "it would have seen other frames";
  EXPECT_GE(nlohmann::json::parse(content(here.path("run.json"))).at("frames_superseded"), 4);
}

// Verifies TS-IFC-065.
TEST(Simulate, RefusesAFlightProgramWithAnotherImageOrTarget) {
  const Workplace here;
  const std::string other = here.put("other.tsm", arbitrary_model("near_shoemaker", 7100));
  for (const std::string& change : {"--model " + other, std::string("--target magellan")}) {
    const std::string flight =
        here.script("flight.sh", std::string("exec ") + FLIGHT_BINARY + " \"$@\" " + change);
    const Outcome outcome = here.run("simulate --sequences 1 --frames 2 --model " + here.model() +
                                     " --flight " + flight + " --report r.html");
    EXPECT_EQ(outcome.exit_code, 1);
    const std::string option = change.substr(0, change.find(' '));
    EXPECT_NE(outcome.errors.find("give both the same " + option), std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.errors.find("the figures cover the others"), std::string::npos) << outcome.errors;
  }
}

// Verifies TS-SEC-040.
TEST(Simulate, RefusesAPipeAsTheKeyThatBothProgramsRead) {
  const Workplace here;
  const Outcome outcome =
      here.run("simulate --command-key /dev/stdin --model " + here.model() + " </dev/null");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.errors.find("is a device; give a file"), std::string::npos) << outcome.errors;
  ASSERT_EQ(mkfifo(here.path("key").c_str(), 0600), 0);
  for (const char* command : {"simulate --command-key key", "console --dds-security key"}) {
    const Outcome of_pipe = here.run(command);
    EXPECT_EQ(of_pipe.exit_code, 2);
    EXPECT_NE(of_pipe.errors.find("'key' is a pipe, which cannot be read twice"), std::string::npos)
        << of_pipe.errors;
  }
}

TEST(Simulate, SaysThatNoStepWasAnsweredAndGivesNoFigures) {
  const Workplace here;
  const Outcome outcome = here.run(
      "simulate --sequences 1 --frames 2 --report r.html --json r.json --flight /bin/false --model " +
      here.model());
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("1 sequence of 2 frames"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("None of the 2 steps was answered"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("0.00"), std::string::npos) << outcome.output;
  EXPECT_EQ(content(here.path("r.html")).find("0.00 ms"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::parse(content(here.path("r.json"))).at("inference_us").at("max").is_null());
}

// Both programs use the default domain without --domain, and the command that the tool prints works.
TEST(Simulate, ShowsTheFlightProgramThatItWaitsFor) {
  const Workplace here;
  auto simulation = std::async(std::launch::async, [&] {
    return here.run("simulate --flight none --sequences 1 --frames 2 --model " + here.model() +
                    " --report r.html");
  });
  std::string command;
  EXPECT_TRUE(wait_for([&] {
    const std::string shown = content(here.path("run.out"));
    const std::size_t start = shown.find(std::string("'") + FLIGHT_BINARY);
    if (start == std::string::npos || shown.find('\n', start) == std::string::npos) return false;
    command = shown.substr(start, shown.find('\n', start) - start);
    return true;
  }));
  EXPECT_NE(command.find("--domain 0"), std::string::npos) << command;
  const Outcome flight = here.run_command("timeout 30 " + command, "flight");
  const Outcome outcome = simulation.get();
  EXPECT_EQ(flight.exit_code, 0) << flight.errors;
  EXPECT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  EXPECT_NE(outcome.output.find("2 of 2 answered"), std::string::npos) << outcome.output;
}

// Verifies TS-SEC-040.
TEST(Simulate, GivesBothSidesTheKeyOfAFile) {
  const Workplace here;
  std::ofstream(here.path("mission.key")) << std::string(64, '7');
  const Outcome outcome = here.run(
      "simulate --sequences 1 --frames 2 --command-key mission.key --report r.html --model " + here.model());
  EXPECT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
}

// Verifies TS-SEC-040.
TEST(Simulate, RefusesAFileThatHoldsNoKey) {
  const Workplace here;
  std::ofstream(here.path("short.key")) << "1234";
  const Outcome outcome =
      here.run("simulate --sequences 1 --frames 2 --command-key short.key --model " + here.model());
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_NE(outcome.errors.find("64 hexadecimal digits"), std::string::npos) << outcome.errors;
}

// The flight program makes one of the files impossible to write during the run.
TEST(Simulate, WritesTheOtherFileWhenOneCannotBeWritten) {
  for (const char* lost : {"run.json", "run.html"}) {
    const Workplace here;
    const std::string flight =
        here.script("flight.sh", "mkdir " + here.path(lost) + "\nexec " + FLIGHT_BINARY + " \"$@\"");
    const Outcome outcome =
        here.run("simulate --sequences 1 --frames 2 --json run.json --report run.html --model " +
                 here.model() + " --flight " + flight);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_NE(outcome.errors.find(std::string("cannot write '") + lost), std::string::npos) << outcome.errors;
    const std::string kept = lost == std::string("run.json") ? "run.html" : "run.json";
    EXPECT_FALSE(content(here.path(kept)).empty()) << kept;
  }
}

TEST(Simulate, SucceedsTwiceAtOnceWithTheSameReport) {
  const Workplace here;
  const std::string arguments =
      "simulate --sequences 3 --frames 4 --report same.html --model " + here.model();
  auto first = std::async(std::launch::async, [&] { return here.run(arguments, "first"); });
  const Outcome second = here.run(arguments, "second");
  EXPECT_EQ(first.get().exit_code, kGuessed) << content(here.path("first.err"));
  EXPECT_EQ(second.exit_code, kGuessed) << second.errors;
  EXPECT_NE(content(here.path("same.html")).find("</html>"), std::string::npos);
  for (const auto& entry : std::filesystem::directory_iterator(here.path(""))) {
    EXPECT_NE(entry.path().extension(), ".partial");
  }
}

// Verifies TS-SIL-040.
TEST(Simulate, ReportsWhatWasDoneWhenTheFlightProgramIsKilled) {
  constexpr int kPlanned = 200;  // at 0.1 s a step: long enough to be interrupted
  const Workplace here;
  const std::string flight =
      here.script("flight.sh", "echo $$ >" + here.path("id") + "\nexec " + FLIGHT_BINARY + " \"$@\"");
  auto simulation = std::async(std::launch::async, [&] {
    return here.run(
        "simulate --sequences 100 --frames 2 --speed 27 --json run.json --report run.html --model " +
        here.model() + " --flight " + flight);
  });
  ASSERT_TRUE(
      wait_for([&] { return content(here.path("run.err")).find("simulating") != std::string::npos; }));
  ASSERT_EQ(kill(std::stoi(content(here.path("id"))), SIGKILL), 0);
  const Outcome outcome = simulation.get();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("signal 9"), std::string::npos) << outcome.errors;

  const auto json = nlohmann::json::parse(content(here.path("run.json")));
  const int answered = kPlanned - json.at("steps_missed").get<int>();
  EXPECT_GT(answered, 0);
  EXPECT_LT(answered, kPlanned);
  EXPECT_TRUE(json.at("rcnn").at("mean_deg").is_number());
  const std::string html = content(here.path("run.html"));
  EXPECT_NE(html.find("The run ended early"), std::string::npos);
  EXPECT_NE(html.find(std::to_string(answered) + " of " + std::to_string(kPlanned)), std::string::npos);
  EXPECT_NE(html.find("<svg"), std::string::npos);
}

// Verifies TS-SIL-040.
TEST(Simulate, ReportsWhatWasDoneWhenItIsInterrupted) {
  const Workplace here;
  const std::string tool =
      here.script("tool.sh", "echo $$ >" + here.path("id") + "\nexec " + TUMBLESIGHT_BINARY + " \"$@\"");
  auto simulation = std::async(std::launch::async, [&] {
    return here.run_command(tool +
                                " simulate --sequences 100 --frames 2 --speed 27 --json run.json --report "
                                "run.html --model " +
                                here.model(),
                            "run");
  });
  EXPECT_TRUE(
      wait_for([&] { return content(here.path("run.err")).find("simulating") != std::string::npos; }));
  ASSERT_EQ(kill(std::stoi(content(here.path("id"))), SIGTERM), 0);
  const Outcome outcome = simulation.get();
  EXPECT_EQ(outcome.exit_code, 128 + SIGTERM);
  EXPECT_NE(outcome.errors.find("interrupted by signal 15"), std::string::npos) << outcome.errors;
  const auto json = nlohmann::json::parse(content(here.path("run.json")));
  EXPECT_GT(json.at("steps_missed"), 0);
  EXPECT_LT(json.at("steps_missed"), 200);
  EXPECT_NE(content(here.path("run.html")).find("The run ended early"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
