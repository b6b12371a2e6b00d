// Command line of the desktop flight program.
#pragma once

#include <cstdint>

namespace tumblesight::hal::dds {

struct FlightOptions {
  static constexpr int kMaxPath = 1024;

  char command_key_path[kMaxPath] = {};  // empty: the development key
  char model_path[kMaxPath] = {};        // empty after parsing: the one shipped for the target
  const char* target = "near_shoemaker";
  bool float32 = false;  // with a model of one's own: whatever the model is of, unless asked for
  bool numerics_given = false;
  std::uint32_t domain = 0;
  std::uint32_t run_id = 0;  // 0: of the first simulator that shows up
  bool free_running = false;
  double period_ms = 2700.0;  // free-running: wall-clock period of the flight task
  double timeout_s = 60.0;    // without a simulator, or without a step from it
  std::uint32_t icd_hash = 0;
};

enum class ParseResult { kRun, kHelp, kError };

// Reports errors on the standard error stream. `options` keeps pointers into `argv`.
ParseResult parse_flight_options(int argc, char** argv, FlightOptions& options);
void print_flight_help();

}  // namespace tumblesight::hal::dds
