#include <gtest/gtest.h>
#include <sys/wait.h>

#include <functional>
#include <ostream>

#include "gnc/numerics/crc.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/dds/idl/icd_hash.hpp"
#include "tests/sil/sil_test_support.hpp"

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
