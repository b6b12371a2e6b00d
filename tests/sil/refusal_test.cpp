#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <ostream>
#include <thread>

#include "gnc/numerics/crc.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/dds/idl/flight_end.hpp"
#include "hal/dds/idl/icd_hash.hpp"
#include "tests/sil/sil_test_support.hpp"
#include "tests/support/former_model_image.hpp"

namespace tumblesight::sim {
namespace {

constexpr hal::Validity kValidityStandby = hal::Validity::kStandby;

// Verifies TS-IFC-060.
TEST(Refusal, UnequalInterfaceHashIsRefusedByBothSides) {
  SilSettings settings = test::settings();
  settings.flight_arguments = {"--icd-hash", "12345"};
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  // The side that notices first reports it: the simulator names the hash, flight the reason for its end.
  EXPECT_TRUE(recording.failure.find("interface hash") != std::string::npos ||
              recording.failure.find("another interface definition") != std::string::npos)
      << recording.failure;
  EXPECT_EQ(recording.steps_missed, 10U);
  const std::string message = test::read_file(settings.flight_log_path);
  EXPECT_NE(message.find("interface hash"), std::string::npos) << message;
  EXPECT_EQ(test::flight_child(), 0);
}

// Verifies TS-IFC-060.
TEST(Refusal, InterfaceHashIsTheCrc32OfTheIdl) {
  std::uint32_t crc = 0xFFFFFFFFU;
  const std::string idl = test::read_file(TUMBLESIGHT_IDL);
  ASSERT_FALSE(idl.empty());
  for (const char c : idl) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1) ^ 0xEDB88320U : crc >> 1;
  }
  EXPECT_EQ(hal::dds::icd_hash(), ~crc);
}

// A flight program that the user starts, in a domain of its own.
class OwnFlight {
 public:
  explicit OwnFlight(std::vector<std::string> arguments, int domain = test::spare_domain())
      : domain_(domain), log_(test::temporary_path("own.log")) {
    const std::vector<std::string> common{"--domain", std::to_string(domain), "--model", test::model_path(),
                                          "--target", test::kTarget};
    arguments.insert(arguments.begin(), common.begin(), common.end());
    process_ = std::make_unique<FlightProcess>(TUMBLESIGHT_FLIGHT, arguments, log_);
  }
  // Settings of a simulator that meets it.
  SilSettings settings() const {
    SilSettings result = test::settings();
    result.flight_path.clear();
    result.flight_log_path.clear();
    result.domain = domain_;
    return result;
  }
  FlightProcess& process() { return *process_; }
  int domain() const { return domain_; }
  std::string pid() const { return std::to_string(process_->pid()); }
  std::string messages() const { return test::read_file(log_); }
  bool has_started() const {
    for (int i = 0; i < 1000 && messages().empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return !messages().empty();
  }

 private:
  int domain_;
  std::string log_;
  std::unique_ptr<FlightProcess> process_;
};

void expect_all_in(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
}

std::string hex(std::uint32_t value) {
  std::array<char, 9> text;
  std::snprintf(text.data(), text.size(), "%08x", static_cast<unsigned>(value));
  return text.data();
}

void expect_ended(OwnFlight& flight, hal::dds::FlightEnd end) {
  EXPECT_TRUE(flight.process().wait_for_end(10.0));
  expect_all_in(flight.process().how_it_ended(),
                {"exit status " + std::to_string(static_cast<int>(end)) + ":"});
}

// Verifies TS-IFC-065.
TEST(Refusal, AnotherTargetIsRefusedByBothSides) {
  OwnFlight flight({"--target", "other_target"});
  const SilRunResult run =
      run_sil(flight.settings(), test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  expect_all_in(run.failure, {test::kTarget, "other_target", "--target"});
  expect_ended(flight, hal::dds::FlightEnd::kOtherSubject);
  expect_all_in(flight.messages(), {test::kTarget, "other_target", "--target"});
}

// Verifies TS-IFC-065.
TEST(Refusal, AnotherModelImageIsRefusedByBothSides) {
  OwnFlight flight({});
  SilSettings settings = flight.settings();
  const std::uint32_t flown = gnc::model_image_crc32(test::model_bytes().data());
  settings.model_crc32 = flown + 1;
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  expect_all_in(run.failure, {hex(flown), hex(flown + 1), settings.model_path, "--model"});
  expect_ended(flight, hal::dds::FlightEnd::kOtherSubject);
  expect_all_in(flight.messages(), {hex(flown), hex(flown + 1), test::model_path(), "--model"});
}

// Verifies TS-IFC-065. Also of a flight program that the simulator starts.
TEST(Refusal, TheSameModelImageIsFlown) {
  SilSettings settings = test::settings();
  settings.model_crc32 = gnc::model_image_crc32(test::model_bytes().data());
  EXPECT_EQ(run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {}).failure, "");
  ++settings.model_crc32;
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  expect_all_in(run.failure, {"model image"});
  EXPECT_EQ(test::flight_child(), 0);
}

// Verifies TS-IFC-065.
TEST(Refusal, ASecondFlightProgramOnTheDomainIsNamedWithTheRemedy) {
  OwnFlight first({});
  ASSERT_TRUE(first.has_started());
  OwnFlight second({}, first.domain());
  // Each ends as soon as it sees the other. One that is slow may find itself alone, and waits on.
  bool first_ended = false, second_ended = false;
  for (int i = 0; i < 100 && !first_ended && !second_ended; ++i) {
    first_ended = first.process().wait_for_end(0.1);
    second_ended = second.process().wait_for_end(0.1);
  }
  OwnFlight& flight = first_ended ? first : second;
  const OwnFlight& other = first_ended ? second : first;
  expect_ended(flight, hal::dds::FlightEnd::kSecondFlight);
  expect_all_in(flight.messages(), {"another flight program", "process " + other.pid(),
                                    "--domain (here " + std::to_string(first.domain()) + ")"});
  EXPECT_EQ(flight.messages().find("interface"), std::string::npos) << flight.messages();
}

// Verifies TS-SIL-040. Its topics do not fit either, but because of the partition.
TEST(Refusal, AnotherRunOnTheDomainIsNotTakenForAnotherInterface) {
  SilSettings settings = test::settings();
  settings.domain = test::spare_domain();
  test::Conversation conversation(settings);
  OwnFlight flight({"--timeout-s", "3"}, settings.domain);
  expect_ended(flight, hal::dds::FlightEnd::kSilence);
  expect_all_in(flight.messages(),
                {"another run is in DDS domain " + std::to_string(settings.domain), "another --domain"});
  EXPECT_EQ(flight.messages().find("interface"), std::string::npos) << flight.messages();
  conversation.step();
  conversation.finish();
}

// Verifies TS-SIL-040.
TEST(Refusal, AMissingLoopbackInterfaceIsNamedByBothSides) {
  const auto alone = [](const std::string& program, const std::string& arguments) {
    return "unshare -rn " + program + " " + arguments;
  };
  if (std::system("unshare -rn true 2>/dev/null") != 0)
    GTEST_SKIP() << "no network namespace can be made here";
  const std::string log = test::temporary_path("alone.log");
  for (const std::string& command :
       {alone(TUMBLESIGHT_FLIGHT,
              "--domain 1 --timeout-s 1 --target test_target --model " + test::model_path()),
        alone(TUMBLESIGHT_SIMULATOR_TO_KILL,
              test::model_path() + " " + TUMBLESIGHT_FLIGHT + " " + log + " 1")}) {
    EXPECT_NE(std::system((command + " > " + log + " 2>&1").c_str()), 0);
    expect_all_in(test::read_file(log),
                  {"DDS domain 1", "loopback interface lo is down", "ip link set lo up"});
    EXPECT_EQ(test::read_file(log).find("another program"), std::string::npos) << test::read_file(log);
  }
}

struct BadModel {
  const char* name;
  const char* message;
  std::function<void(std::vector<std::uint8_t>&)> spoil;
};

// The name of a case in messages: GoogleTest would print addresses.
void PrintTo(const BadModel& model, std::ostream* out) {
  *out << model.name;
}

// A complete image of another network, with a correct CRC in its header.
void change_architecture(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kArchitecture = 12;
  constexpr std::size_t kHeaderCrc = 92;
  bytes[kArchitecture] ^= 1;
  gnc::Crc32 crc;
  crc.add(bytes.data(), kHeaderCrc);
  crc.add(bytes.data() + gnc::kModelHeaderSize,
          gnc::kModelDataOffset<gnc::FixedPoint> - gnc::kModelHeaderSize);
  for (unsigned i = 0; i < 4; ++i) bytes[kHeaderCrc + i] = static_cast<std::uint8_t>(crc.value() >> (8 * i));
}

class RefusedModel : public ::testing::TestWithParam<BadModel> {};

// Verifies TS-IFC-020, TS-IFC-030, TS-IFC-050.
TEST_P(RefusedModel, FlightNamesItAndAnswersInSafe) {
  std::vector<std::uint8_t> bytes = test::model_bytes();
  GetParam().spoil(bytes);
  SilSettings settings = test::settings();
  settings.model_path = test::temporary_path("bad.tsm");
  test::write_file(settings.model_path, bytes);

  test::Conversation conversation(settings);
  EXPECT_EQ(conversation.session.flight_mode(), hal::Mode::kSafe);
  const StepAnswer first = conversation.step();
  EXPECT_EQ(first.telemetry.mode, hal::Mode::kSafe);
  EXPECT_EQ(first.attitude.validity, kValidityStandby);
  ASSERT_FALSE(first.events.empty());
  EXPECT_EQ(first.events[0].id, hal::EventId::kModelRefused);
  EXPECT_EQ(conversation.finish().attitude.validity, kValidityStandby);
  const std::string message = test::read_file(settings.flight_log_path);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_NE(message.find("SAFE"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Sil, RefusedModel,
    ::testing::Values(BadModel{"Magic", "magic", [](auto& bytes) { bytes[0] ^= 1; }},
                      BadModel{"Version", "version", [](auto& bytes) { bytes[4] ^= 0xFF; }},
                      BadModel{"FormerVersion", "quantize --surface-only renews an earlier one",
                               [](auto& bytes) { bytes = gnc::former_model_image(4, bytes); }},
                      BadModel{"HeaderCrc", "header", [](auto& bytes) { bytes[49] ^= 1; }},
                      BadModel{"Architecture", "network architecture", change_architecture},
                      BadModel{"TooLarge", "too large",
                               [](auto& bytes) { bytes.resize(8U * 1024U * 1024U + 1U); }},
                      BadModel{"WeightCrc", "CRC", [](auto& bytes) { bytes[bytes.size() - 9] ^= 1; }},
                      BadModel{"Size", "size", [](auto& bytes) { bytes.resize(bytes.size() - 4); }},
                      BadModel{"TooShort", "short", [](auto& bytes) { bytes.resize(40); }},
                      BadModel{"Empty", "file is empty", [](auto& bytes) { bytes.clear(); }}),
    [](const auto& test) { return std::string(test.param.name); });

// Verifies TS-IFC-030.
TEST(Refusal, ModelOfAnotherTargetEndsTheRunWithTheReason) {
  SilSettings settings = test::settings();
  settings.target = "another_target";
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(recording.failure.find("SAFE"), std::string::npos) << recording.failure;
  EXPECT_NE(test::read_file(settings.flight_log_path).find("target"), std::string::npos);
}

// Verifies TS-IFC-070, TS-SIL-040.
TEST(Refusal, MissingFilesAreNamed) {
  SilSettings settings = test::settings();
  settings.model_path = "/nonexistent/model.tsm";
  const SilRunResult no_model = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(no_model.failure.find("/nonexistent/model.tsm"), std::string::npos) << no_model.failure;
  settings.flight_path = "/nonexistent/flight";
  const SilRunResult no_flight = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(no_flight.failure.find("/nonexistent/flight"), std::string::npos) << no_flight.failure;
}

// Verifies TS-SIL-040.
TEST(Refusal, BadArgumentsOfFlightAreNamed) {
  const std::vector<std::vector<std::string>> cases{
      {"--domain", "231"}, {"--domain", "-1"}, {"--period-ms", "nan"}, {"--mode", "fast"},
      {"--colour", "red"}, {"--run-id"},       {"--period-ms", "10"},  {"--reset", "watchdog"}};
  for (const std::vector<std::string>& arguments : cases) {
    SilSettings settings = test::settings();
    settings.flight_arguments = arguments;
    const SilRunResult recording =
        run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
    EXPECT_NE(recording.failure.find("exit status 2"), std::string::npos) << recording.failure;
    const std::string message = test::read_file(settings.flight_log_path);
    EXPECT_NE(message.find(arguments[0]), std::string::npos) << message;
  }
}

// Verifies TS-SIL-040.
TEST(Refusal, RunWithoutAFlightProgramIsReported) {
  SilSettings settings = test::settings();
  settings.flight_path.clear();
  settings.step_timeout_s = 0.3;
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(recording.failure.find("no flight program"), std::string::npos) << recording.failure;
}

}  // namespace
}  // namespace tumblesight::sim
