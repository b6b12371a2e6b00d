// `tumblesight replay` as a user runs it, flight program and DDS included.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <future>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>

#include "sim/cli/sensor_arguments.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

class Replay : public ::testing::Test {
 protected:
  // Four frames of one sequence with their truth beside them. Another one was lost before the last.
  void SetUp() override {
    const Outcome recorded =
        here.run("record --sequences 1 --frames 6 --loss-every 4 --seed 4 --out frames.tslr");
    ASSERT_EQ(recorded.exit_code, 0) << recorded.errors;
  }
  Outcome replay(const std::string& arguments) const {
    return here.run("replay frames.tslr --model " + here.model() + " --report r.html " + arguments);
  }
  void expect_refused(const Outcome& outcome, int exit_code, const std::string& message) const {
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << outcome.errors;
  }

  const Workplace here{};
};

// Verifies TS-SIL-140.
TEST_F(Replay, TakesTheTruthBesideTheRecordingAndSaysSo) {
  const Outcome outcome = replay("--json r.json");
  EXPECT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  EXPECT_NE(outcome.output.find("truth: frames.truth.csv (beside the recording), of 4 of the 4 frames"),
            std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("no frame"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("5 of 5 answered"), std::string::npos) << outcome.output;
  const auto json = nlohmann::json::parse(content(here.path("r.json")));
  EXPECT_EQ(json.at("cycles"), 5);
  EXPECT_EQ(json.at("cycles_without_frame"), 1);
  EXPECT_EQ(json.at("frames_scored"), 4);
  EXPECT_TRUE(json.at("error_all").at("mean_deg").is_number());
  EXPECT_NE(content(here.path("r.html")).find("</html>"), std::string::npos);
}

// Verifies TS-SIL-140.
TEST_F(Replay, ReportsValidityAndExpectedErrorsWithoutTruth) {
  const Outcome outcome = replay("--truth none --json r.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("truth: none"), std::string::npos) << outcome.output;
  const auto json = nlohmann::json::parse(content(here.path("r.json")));
  EXPECT_EQ(json.count("error_all"), 0U);
  EXPECT_TRUE(json.at("rows").at(0).at("error_deg").is_null());
  EXPECT_TRUE(json.at("rows").at(0).at("expected_error_deg").is_number());
  std::filesystem::remove(here.path("frames.truth.csv"));
  EXPECT_NE(
      replay("").output.find("truth: none beside the recording (frames.truth.csv); --truth names another"),
      std::string::npos);
}

// Verifies TS-SIL-380. Random weights, so that the attitudes are guesses.
TEST_F(Replay, SaysThatTheAttitudesAreMostlyWrongUnlessAnotherBodyWasRecorded) {
  EXPECT_NE(replay("").output.find(" % of the attitudes are more than 20° off"), std::string::npos);
  ASSERT_EQ(here.run("record --effect sphere=1 --sequences 1 --frames 3 --out ball.tslr").exit_code, 0);
  const Outcome ball = here.run("replay ball.tslr --report r.html --model " + here.model());
  EXPECT_EQ(ball.exit_code, 0) << ball.errors;
  EXPECT_EQ(ball.output.find("more than 20° off"), std::string::npos) << ball.output;
}

TEST_F(Replay, CountsFramesThatTheTruthLeavesOut) {
  std::string truth = content(here.path("frames.truth.csv"));
  truth.erase(truth.rfind('\n', truth.size() - 2) + 1);
  std::ofstream(here.path("part.csv")) << truth;
  const Outcome outcome = replay("--truth part.csv --json r.json");
  EXPECT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  EXPECT_NE(outcome.output.find("truth: part.csv, of 3 of the 4 frames"), std::string::npos)
      << outcome.output;
  const auto json = nlohmann::json::parse(content(here.path("r.json")));
  EXPECT_EQ(json.at("frames_scored"), 3);
  EXPECT_TRUE(json.at("rows").at(4).at("error_deg").is_null());
}

// Verifies TS-SIL-150.
TEST_F(Replay, NotesATruthOfAnotherTargetOrSensorWithBothNames) {
  EXPECT_EQ(replay("").errors.find("note: The"), std::string::npos) << "recorded for this target and sensor";
  const SensorDescription scan = sensor_named("scan_128");
  ASSERT_EQ(here.run("record --target magellan --sensor scan_128 --sequences 1 --frames 2 --out other.tslr")
                .exit_code,
            0);
  const std::string common = "replay other.tslr --report r.html --model " + here.model();
  const Outcome other = here.run(common);
  EXPECT_EQ(other.exit_code, kGuessed) << other.errors;
  for (const std::string& part :
       {std::string(
            "The truth in 'other.truth.csv', line 2, is of target magellan, and the flight program looks "
            "for near_shoemaker."),
        "The frames are of sensor " + to_string(scan),
        std::string("no model.sensor.json says for which sensor")})
    EXPECT_NE(other.errors.find(part), std::string::npos) << other.errors;
  EXPECT_NE(content(here.path("r.html")).find("is of target magellan"), std::string::npos);
  write_sensor_file(here.path("model.tsm"), sensor_named("flash_256"));
  EXPECT_NE(here.run(common).errors.find("the network was trained for sensor flash_256 (CRC-32 "),
            std::string::npos);
  write_sensor_file(here.path("model.tsm"), scan);
  EXPECT_EQ(here.run(common).errors.find("The frames are of sensor"), std::string::npos);
}

// Verifies TS-SIL-130.
TEST_F(Replay, RefusesFilesThatAreWrongOrOfAnotherRecording) {
  std::ofstream(here.path("other.csv"))
      << content(here.path("frames.truth.csv")) << "77,1,1,0,0,0,0,0,0,0,9,0,near_shoemaker,paper,54057624\n";
  expect_refused(replay("--truth other.csv"), 1,
                 "other.csv, line 6: the recording has no frame with sequence_number 77");
  expect_refused(replay("--truth frames.tslr"), 1, "frames.tslr, line 1: there is no column 'TSLR");
  expect_refused(replay("--truth missing.csv"), 1, "'missing.csv' cannot be read");
  expect_refused(here.run("replay frames.truth.csv"), 1,
                 "recording 'frames.truth.csv': not a recording; write it with");
  expect_refused(here.run("replay nothing.tslr"), 2, "'nothing.tslr' does not exist");
  expect_refused(replay("--json frames.tslr"), 2, "--json: 'frames.tslr' is also the file of RECORDING");
  expect_refused(replay("--json frames.truth.csv"), 2, "is also the file of --truth");
  expect_refused(replay("--target magellan"), 1, "is refused: ");
  EXPECT_NE(content(here.path("frames.tslr")), "") << "the recording is kept";
}

// Verifies TS-IFC-065.
TEST_F(Replay, FailsWithAFlightProgramForAnotherTarget) {
  const std::string flight =
      here.script("flight.sh", std::string("exec ") + FLIGHT_BINARY + " \"$@\" --target magellan");
  expect_refused(replay("--flight " + flight), 1, "give both the same --target");
  EXPECT_NE(content(here.path("r.html")).find("The run ended early"), std::string::npos);
}

// Verifies TS-SIL-040.
TEST_F(Replay, ReportsWhatWasDoneWhenItIsInterrupted) {
  const std::string tool =
      here.script("tool.sh", "echo $$ >" + here.path("id") + "\nexec " + TUMBLESIGHT_BINARY + " \"$@\"");
  const std::string arguments =
      tool + " replay frames.tslr --speed 1 --json r.json --report r.html --model " + here.model();
  auto replay = std::async(std::launch::async, [&] { return here.run_command(arguments, "run"); });
  for (int i = 0; i < 600 && content(here.path("run.err")).find("replaying") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ASSERT_EQ(kill(std::stoi(content(here.path("id"))), SIGINT), 0);
  expect_refused(replay.get(), 128 + SIGINT, "interrupted by signal 2");
  const auto json = nlohmann::json::parse(content(here.path("r.json")));
  EXPECT_GT(json.at("steps_missed"), 0);
  EXPECT_LT(json.at("steps_missed"), 5);
  EXPECT_NE(content(here.path("r.html")).find("The run ended early"), std::string::npos);
}

// Verifies TS-SIL-140.
TEST(WriteRecording, WritesWhatReplayReads) {
  const Workplace here{};
  const Outcome written = here.run_command(
      PYTHON " -B " TUMBLESIGHT_SOURCE_DIR "/docs/examples/write_recording.py box.tslr", "script");
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const Outcome outcome = here.run("replay box.tslr --report r.html --json r.json --model " + here.model());
  EXPECT_EQ(outcome.exit_code, kGuessed) << outcome.errors;
  const auto json = nlohmann::json::parse(content(here.path("r.json")));
  EXPECT_EQ(json.at("cycles"), 10);
  EXPECT_EQ(json.at("cycles_without_frame"), 1);
  EXPECT_EQ(json.at("frames_scored"), 9);
  EXPECT_GT(json.at("rows").at(0).at("returns"), 1000);
  for (const char* const name : {"run.1", "run.2"}) {
    const Outcome one = here.run_command(
        std::string(PYTHON " -B " TUMBLESIGHT_SOURCE_DIR "/docs/examples/write_recording.py ") + name,
        "script");
    ASSERT_EQ(one.exit_code, 0) << one.errors;
    EXPECT_NE(here.run(std::string("replay ") + name + " --report r.html --model " + here.model())
                  .output.find(std::string("truth: ") + name + ".truth.csv (beside the recording)"),
              std::string::npos)
        << name;
  }
  const Outcome corners = here.run_command(
      "PYTHONPATH=" TUMBLESIGHT_SOURCE_DIR "/docs/examples " PYTHON
      " -B -c '"
      "import write_recording as w\n"
      "r = w.ranges_of_points([(1.9, 20, 1.9), (-1.9, 30, -1.9), (0.5, -20, 0.5)], 16, 0.2)\n"
      "print([(row, column) for row in range(16) for column in range(16) if r[row][column]])'",
      "corners");
  EXPECT_EQ(corners.output, "[(0, 15), (13, 2)]\n") << corners.errors;
}

TEST_F(Replay, OfTwoRecordingsOfOneNameHasTwoReports) {
  std::set<std::string> reports;
  for (const char* folder : {"a", "b"}) {
    std::filesystem::create_directory(here.path(folder));
    std::filesystem::copy_file(here.path("frames.tslr"), here.path(std::string(folder) + "/run.tslr"));
    const Outcome outcome =
        here.run(std::string("replay ") + folder + "/run.tslr --json r.json --model " + here.model());
    const std::size_t name = outcome.output.find("/run_");
    ASSERT_NE(name, std::string::npos) << outcome.output;
    const std::size_t line = outcome.output.find_last_of(" \n", name) + 1;
    reports.insert(outcome.output.substr(line, outcome.output.find('\n', name) - line));
  }
  EXPECT_EQ(reports.size(), 2U);
  for (const std::string& report : reports) EXPECT_TRUE(std::filesystem::remove(report)) << report;
}

// Organised clouds, as of PCD and ROS, have NaN where nothing returned.
TEST(WriteRecording, TakesPointsAndRangesThatAreNotFiniteForNoReturn) {
  const Workplace here{};
  const Outcome outcome = here.run_command(
      "PYTHONPATH=" TUMBLESIGHT_SOURCE_DIR "/docs/examples " PYTHON
      " -B -c '"
      "import write_recording as w\n"
      "nan, inf = float(\"nan\"), float(\"inf\")\n"
      "points = [(nan, nan, nan), (nan, 20, 0), (0, 20, nan), (0, inf, 0), (inf, 20, 0), (0, 20, 0)]\n"
      "print(sum(map(bool, sum(w.ranges_of_points(points, 16, 0.2), []))))\n"
      "print(w.encoded_row([nan, inf, 20.0, nan]) == w.encoded_row([0, 0, 20.0, 0]))'",
      "not_finite");
  EXPECT_EQ(outcome.output, "1\nTrue\n") << outcome.errors;
}

// A target that is nearer than the flight program looks has many returns, and none that counts.
TEST_F(Replay, SaysWhyNoFrameIsAccepted) {
  const Outcome written = here.run_command(
      "PYTHONPATH=" TUMBLESIGHT_SOURCE_DIR "/docs/examples " PYTHON
      " -B -c '"
      "import write_recording as w\n"
      "points = [(0.01 * x, 8 + 0.02 * x, 0.01 * z) for x in range(-50, 50) for z in range(-50, 50)]\n"
      "w.write_recording(\"near.tslr\", 64, [dict(sequence_number=1, exposure_time_ns=0, fov_rad=0.3,"
      " ranges_m=w.ranges_of_points(points, 64, 0.3))])'",
      "near");
  ASSERT_EQ(written.exit_code, 0) << written.errors;
  const Outcome outcome = here.run("replay near.tslr --report r.html --json r.json --model " + here.model());
  EXPECT_EQ(outcome.exit_code, kOfNoUse) << outcome.errors;
  EXPECT_NE(outcome.output.find("nearer than 10 m left out"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("No frame of the recording was accepted"), std::string::npos)
      << outcome.output;
  EXPECT_NE(content(here.path("r.html")).find("No frame of the recording was accepted"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
