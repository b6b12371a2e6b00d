// Command line of the desktop flight program.
#pragma once

#include <cstdint>

#include "fsw/programs/desktop/flight_program.hpp"
#include "hal/dds/idl/run_secret.hpp"
#include "hal/messages/reset_cause.hpp"

namespace tumblesight::fsw::desktop {

struct FlightOptions {
  static constexpr int kMaxPath = 1024;

  char command_key_path[kMaxPath] = {};  // empty: the development key
  char model_path[kMaxPath] = {};        // empty: the shipped model of the target
  char packets_path[kMaxPath] = {};      // empty: no packets are written
  char state_path[kMaxPath] = {};        // empty: nothing is kept
  bool model_given = false;
  bool reset_given = false;
  hal::ResetCause reset_cause = hal::ResetCause::kPowerOn;
  const char* target = "near_shoemaker";
  bool float32 = kFlyFloat32;  // without numerics_given and with a model_path: decided by the model image
  bool numerics_given = false;
  std::uint32_t domain = 0;
  std::uint32_t run_id = 0;                                        // 0: that of the first simulator found
  char partition[hal::dds::RunSecret::kPartitionDigits + 1] = {};  // empty: the default one
  char security_path[kMaxPath] = {};                               // empty: the bus is not secured
  bool free_running = false;
  bool period_given = false;
  double period_ms = 2700.0;  // free-running: wall-clock period of the flight task
  double timeout_s = 60.0;    // the run ends after this long without a simulator or a step
  std::uint32_t icd_hash = 0;
};

enum class ParseResult { kRun, kHelp, kVersion, kError };

// Reports errors on the standard error stream. `options` keeps pointers into `argv`.
ParseResult parse_flight_options(int argc, char** argv, FlightOptions& options);
// Both: false if the standard output cannot be written; the reason is written to the standard error stream.
[[nodiscard]] bool print_flight_help();
// Program version, commit, format version of model images, hash of the interface definition: one per line.
[[nodiscard]] bool print_flight_version();

}  // namespace tumblesight::fsw::desktop
