#include "sim/sil/flight_process.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "hal/dds/idl/run_secret.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

TEST(FlightProcess, DistinguishesSuccessFromFailure) {
  FlightProcess good("/bin/true", {}, "");
  FlightProcess bad("/bin/false", {}, "");
  ASSERT_TRUE(good.wait_for_end(5.0));
  ASSERT_TRUE(bad.wait_for_end(5.0));
  EXPECT_TRUE(good.ended_well());
  EXPECT_FALSE(bad.ended_well());
}

TEST(FlightProcess, EndWithoutAStatusIsAFailure) {
  const auto before = signal(SIGCHLD, SIG_IGN);
  FlightProcess process("/bin/false", {}, "");
  EXPECT_TRUE(process.wait_for_end(5.0));
  signal(SIGCHLD, before);
  EXPECT_FALSE(process.ended_well());
  EXPECT_NE(process.how_it_ended().find("status is lost"), std::string::npos) << process.how_it_ended();
}

// Starts the flight program as the simulator has asked for it, and leaves both texts in files.
std::string program_that_notes_how_it_was_started(const std::string& arguments, const std::string& secret) {
  const std::string path = test::temporary_path("noting_flight");
  std::ofstream(path) << "#!/bin/sh\nprintf '%s ' \"$@\" > '" << arguments << "'\nprintf %s \"$"
                      << hal::dds::kRunSecretVariable << "\" > '" << secret << "'\nexec '"
                      << TUMBLESIGHT_FLIGHT << "' \"$@\"\n";
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

// Verifies TS-SIL-095.
TEST(FlightProcess, LearnsTheRunsSecretFromItsEnvironmentOnly) {
  const std::string arguments_path = test::temporary_path("arguments");
  const std::string secret_path = test::temporary_path("secret");
  SilSettings settings = test::settings();
  settings.flight_path = program_that_notes_how_it_was_started(arguments_path, secret_path);
  const SilRunResult run = run_sil(settings, test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_EQ(run.failure, "");
  hal::dds::RunSecret secret;
  ASSERT_TRUE(hal::dds::read_run_secret(test::read_file(secret_path).c_str(), secret));
  const std::string arguments = test::read_file(arguments_path);
  EXPECT_NE(arguments.find("--target"), std::string::npos) << arguments;
  EXPECT_EQ(arguments.find(std::to_string(secret.run_id)), std::string::npos) << arguments;
  EXPECT_EQ(arguments.find(secret.partition), std::string::npos) << arguments;
}

// Verifies TS-MEM-020.
TEST(FlightProcess, HeapUsedAfterTheLastTelemetryIsAFailureOfTheRun) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer must be loaded before any other library";
#endif
  const test::Environment preload("LD_PRELOAD", TUMBLESIGHT_FAULT_IN_FLIGHT);
  const test::Environment fault("TUMBLESIGHT_FAULT", "heap");
  const SilSettings settings = test::settings();
  const std::vector<Sequence> one_step{make_sequence({Condition::kNominal, 1}, 1, 0)};
  const SilRunResult recording = run_sil(settings, test::lidar(), test::kSwath_m, one_step, {});
  EXPECT_EQ(recording.steps_missed, 0U);
  EXPECT_EQ(recording.flight_heap_allocations, 0U) << "the telemetry was sent before the allocation";
  EXPECT_NE(recording.failure.find("used the heap"), std::string::npos) << recording.failure;
  EXPECT_NE(test::read_file(settings.flight_log_path).find("used the heap 1 times, first for 77 bytes"),
            std::string::npos);
}

TEST(FlightProcess, MissingThreadForTheFlightTaskIsReported) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer must be loaded before any other library";
#endif
  const test::Environment preload("LD_PRELOAD", TUMBLESIGHT_FAULT_IN_FLIGHT);
  const test::Environment fault("TUMBLESIGHT_FAULT", "thread");
  const SilRunResult recording =
      run_sil(test::settings(), test::lidar(), test::kSwath_m, test::sequences(1, 1), {});
  EXPECT_NE(recording.failure.find("no thread for the flight task"), std::string::npos) << recording.failure;
}

}  // namespace
}  // namespace tumblesight::sim
