// Start of the flight program: the choice between fixed point and float32, and what the two programs say of
// themselves.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "gnc/numerics/crc.hpp"
#include "hal/dds/idl/flight_end.hpp"
#include "hal/persistent_store.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;
using hal::dds::FlightEnd;

struct Ended {
  int status = -1;  // exit status, or 128 and the signal
  std::string text;
};

// Runs a command in bash until it ends.
Ended run(const std::string& command) {
  const std::string log = test::temporary_path("output");
  const std::string script = test::temporary_path("script");
  const std::string line = "exec timeout 30 " + command + "\n";
  test::write_file(script, {line.begin(), line.end()});
  const int status = std::system(("bash " + script + " >" + log + " 2>&1").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), test::read_file(log)};
}

// A run without a simulator: it ends after the shortest wait.
Ended run_alone(const std::string& program, const std::string& arguments) {
  return run(program + " --timeout-s 0.1 --domain " + std::to_string(test::spare_domain()) + " " + arguments);
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string kFlight = TUMBLESIGHT_FLIGHT;
const std::string kFlightFloat32 = kFlight + "_float32";

// The flight program in a folder of its own.
std::string lonely_flight() {
  const std::string folder = test::temporary_path("lonely");
  fs::create_directory(folder);
  fs::copy_file(kFlight, folder + "/flight");
  return folder + "/flight";
}

bool widest_line_fits(const std::string& text, std::size_t columns) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() > columns) return false;
  }
  return true;
}

class FlightProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kFlightFloat32)) GTEST_SKIP() << "built without TUMBLESIGHT_FLOAT32";
  }
};

// A pipe gives its content once.
TEST_F(FlightProgram, TakesItsKeyFromAPipeInBothNumerics) {
  for (const char* const numerics : {"fixed", "float32"}) {
    const Ended ended = run_alone(
        kFlight, std::string("--command-key <(printf %064d 7) --model none.tsm --numerics ") + numerics);
    EXPECT_EQ(ended.status, static_cast<int>(FlightEnd::kSilence)) << ended.text;
    EXPECT_FALSE(has(ended.text, "hexadecimal")) << ended.text;
  }
}

TEST_F(FlightProgram, IsStoppedByARequestDuringTheChangeToFloat32) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer must be loaded before any other library";
#endif
  const test::Environment preload("LD_PRELOAD", TUMBLESIGHT_FAULT_IN_FLIGHT);
  const test::Environment fault("TUMBLESIGHT_FAULT", "stop at exec");
  const Ended ended = run_alone(kFlight, "--numerics float32");
  EXPECT_EQ(ended.status, 128 + SIGTERM) << ended.text;
}

TEST_F(FlightProgram, EndsWhenTheFloat32ProgramCannotBeStarted) {
  const std::string lonely = lonely_flight();
  for (const bool not_executable : {false, true}) {
    if (not_executable) test::write_file(lonely + "_float32", {'x'});
    const Ended ended = run_alone(lonely, "--numerics float32");
    EXPECT_EQ(ended.status, static_cast<int>(FlightEnd::kNoFloat32Program)) << ended.text;
    EXPECT_TRUE(has(ended.text, lonely + "_float32")) << ended.text;
    EXPECT_TRUE(has(ended.text, "build its target: flight_float32")) << ended.text;
    EXPECT_TRUE(has(ended.text, not_executable ? "Permission denied" : "No such file")) << ended.text;
    EXPECT_FALSE(has(ended.text, "SAFE")) << ended.text;
  }
}

TEST_F(FlightProgram, InFloat32SaysWhatItIs) {
  const Ended help = run(kFlightFloat32 + " --help");
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.text.find("flight_float32: "), 0U) << help.text;
  EXPECT_TRUE(has(help.text, "Start `flight`")) << help.text;
  EXPECT_TRUE(widest_line_fits(help.text, 80)) << help.text;
  EXPECT_EQ(run(kFlightFloat32 + " --version").text.find("flight_float32 "), 0U);
  for (const char* const arguments : {"--colour red", "--numerics fixed", "--domain x"}) {
    const Ended ended = run(kFlightFloat32 + " " + arguments);
    EXPECT_EQ(ended.status, static_cast<int>(FlightEnd::kBadArguments)) << ended.text;
    EXPECT_EQ(ended.text.find("flight_float32: "), 0U) << ended.text;
  }
  EXPECT_TRUE(has(run(kFlightFloat32 + " --numerics fixed").text, "start flight"));
}

TEST_F(FlightProgram, InFloat32TakesTheShippedFloat32Image) {
  const Ended ended = run_alone(kFlightFloat32, "");
  EXPECT_EQ(ended.status, static_cast<int>(FlightEnd::kSilence)) << ended.text;
  EXPECT_FALSE(has(ended.text, "SAFE")) << ended.text;
}

TEST_F(FlightProgram, NamesTheCommandThatGetsAMissingImage) {
  const std::string folder = test::temporary_path("models");
  fs::create_directory(folder);
  const std::string arguments = "--numerics float32 --model " + folder + "/x.float32.tsm";
  EXPECT_FALSE(has(run_alone(kFlight, arguments).text, "fetch_images"));
  test::write_file(folder + "/fetch_images", {});
  const Ended ended = run_alone(kFlight, arguments);
  EXPECT_TRUE(
      has(ended.text, "no such file; get it with: fsw/models/fetch_images x.float32; the mode is SAFE"))
      << ended.text;
}

// A run with the text as the content of the file `path`, unless it is empty.
Ended run_with_file(const std::string& path, const std::string& text, const std::string& arguments) {
  if (!text.empty()) test::write_file(path, {text.begin(), text.end()});
  return run_alone(kFlight, arguments);
}

void expect_refused(const Ended& ended, const std::string& reason) {
  EXPECT_EQ(ended.status, static_cast<int>(FlightEnd::kBadArguments)) << ended.text;
  EXPECT_TRUE(has(ended.text, reason)) << ended.text;
}

// Verifies TS-RST-060.
TEST(FlightState, FileThatIsNoStateFileIsRefusedAndKept) {
  const std::string path = test::temporary_path("notes");
  const std::string text(hal::kStoredBytes, 'a');
  for (const std::string& option : {"--state " + path, "--packets " + path}) {
    expect_refused(run_with_file(path, text, option), path);
    EXPECT_EQ(test::read_file(path), text);
  }
  expect_refused(run_alone(kFlight, "--state /dev/full"), "/dev/full: is not a regular file");
  expect_refused(run_alone(kFlight, "--state /no/such/state"), "/no/such/state: No such file");
}

// Verifies TS-RST-060.
TEST(FlightState, FileOfThePacketsIsRefused) {
  const std::string path = test::temporary_path("both");
  for (const char* const end : {"", ".copy", ".new"}) {
    expect_refused(run_alone(kFlight, "--state " + path + " --packets " + path + end), "--packets");
    EXPECT_FALSE(fs::exists(path + end));
  }
}

// The beginning of a record, and a wrong checksum.
std::string damaged_record() {
  std::string record("TSST");
  record.resize(hal::kStoredBytes);
  return record;
}

// Verifies TS-RST-060.
TEST(FlightState, DamagedStateIsReportedWithTheRemedy) {
  const std::string path = test::temporary_path("damaged");
  const Ended ended = run_with_file(path, damaged_record(), "--state " + path);
  EXPECT_TRUE(
      has(ended.text,
          "--state " + path +
              ": not all of the stored state could be used; lost: command counter and key slot, mode, bank, "
              "disabled responses and parameter table; load it again; the mode is SAFE; send SET_MODE "
              "STANDBY, then SET_MODE RUN, or delete " +
              path))
      << ended.text;
}

// A record as docs/icd.md, 2.8, describes it, of key slot 1, mode RUN and counter 5, with a table of other
// software.
std::string record_of_other_software() {
  std::string record("TSST\x03\x01\0\0\0\0\0\x01\0\0\0\x05", 16);
  const auto close = [&record](std::size_t size) {
    record.resize(size - 4);
    const std::uint32_t crc = gnc::crc32(reinterpret_cast<const std::uint8_t*>(record.data()), record.size());
    for (int shift = 24; shift >= 0; shift -= 8) record += static_cast<char>(crc >> shift);
  };
  close(20);
  record += std::string("\0\x02\0\0\0\0\0\0", 8);
  close(hal::kStoredBytes);
  return record;
}

// Verifies TS-RST-060. `flight` has a key in slot 0 only.
TEST(FlightState, PartOfTheStateThatIsLostIsNamed) {
  const std::string path = test::temporary_path("other");
  const Ended ended = run_with_file(path, record_of_other_software(), "--state " + path);
  EXPECT_TRUE(has(ended.text,
                  "lost: parameter table, key slot (the stored one has no key); load it again; the "
                  "mode is SAFE; send SET_MODE STANDBY, then SET_MODE RUN, or delete " +
                      path))
      << ended.text;
}

TEST(FlightModel, OfATargetThatDoesNotShipIsMissedWithTheRemedy) {
  const Ended ended = run_alone(kFlight, "--target sputnik");
  EXPECT_TRUE(
      has(ended.text, "fsw/models/sputnik.tsm: no such file; give --model, or the --target of an image"))
      << ended.text;
  expect_refused(run_alone(kFlight, "--target ../x"), "--target '../x': expected 1 to 31 characters");
  expect_refused(run_alone(kFlight, "--model ''"), "--model '': expected a file's path");
}

TEST(FlightOptions, SecurityThatCannotBeReadIsReportedOnceWithTheLimit) {
  const Ended ended = run_alone(kFlight, "--dds-security /no/such");
  expect_refused(ended, "--dds-security /no/such: cannot be read, is empty, or has ");
  EXPECT_FALSE(has(ended.text, "bad arguments")) << ended.text;
}

TEST(Security, FileThatIsNoneIsNamed) {
  SilSettings settings = test::settings();
  settings.security_path = test::temporary_path("no.xml");
  test::write_file(settings.security_path, {'h', 'e', 'l', 'l', 'o'});
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_TRUE(
      has(run.failure, "is --dds-security " + settings.security_path + " a file of hal/dds/make_security"))
      << run.failure;
}

TEST(FlightHelp, OutputThatCannotBeWrittenIsAFailure) {
  for (const std::string& program : {kFlight, std::string(TUMBLESIGHT_PROGRAM)}) {
    for (const char* const option : {" --help", " --version"}) {
      const Ended ended = run(program + option + " >/dev/full");
      EXPECT_EQ(ended.status, 1) << program << option;
      EXPECT_TRUE(has(ended.text, "standard output: No space left")) << ended.text;
    }
  }
}

TEST(FlightHelp, FitsATerminal) {
  const Ended help = run(kFlight + " --help");
  EXPECT_EQ(help.text.find("flight: "), 0U);
  EXPECT_TRUE(widest_line_fits(help.text, 80)) << help.text;
}

}  // namespace
}  // namespace tumblesight::sim
