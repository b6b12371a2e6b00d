// The options of the verbs that run the flight program, and what these verbs do with them: simulate, replay.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sim/cli/command.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/report/run_page.hpp"
#include "sim/sil/sil_run.hpp"

namespace tumblesight::sim {

inline constexpr const char* kFastestPossible = "max";  // as a speed

struct FlightArguments {
  std::string speed = kFastestPossible;
  bool free_running = false;
  std::string flight;       // empty: in the folder of this program; "none": started by the user
  std::string command_key;  // file; empty: the public development key
  std::string security;     // file; empty: the bus is not secured
  int domain = -1;          // -1: none given
  std::string mcap;         // file; empty: the run is not recorded
  std::string report;       // file
  std::string command_line;
};

// --speed, --flight, --command-key, --dds-security, --domain, --mcap.
void add_flight_options(Command& command, FlightArguments& arguments);

// Throws std::runtime_error that names the flight program or the key if it cannot be used.
SilSettings sil_settings(const FlightArguments& arguments, const std::string& target,
                         const TargetSetup& setup);
// What the report says about the run's settings.
FlightSetup flight_setup(const std::string& target, const TargetSetup& setup, const SilSettings& settings);

// Throws as require_usable_files() does for the report and the figures. `read`: the files that the verb reads
// beside those of `arguments`. `json` empty: no figures.
void require_usable_outputs(const FlightArguments& arguments, OptionFiles read, const std::string& json);
// <name> in the folder that a program writes to by default.
std::string default_report_path(const std::string& name);

// Prints what the user has to start (--flight none), and the remarks of the setup on the standard error
// stream.
void announce_flight(const SilSettings& settings, const TargetSetup& setup);

// Writes report and figures, even if one of them cannot be written, and prints the faults of the run and of
// the files. Throws Exit with the exit status unless all went well: 1, or 128 and the signal
// that ended the run, or kOfNoUse if nothing failed and the attitudes are mostly wrong.
void finish_flight(const FlightArguments& arguments, const std::string& page, const std::string& json,
                   const nlohmann::ordered_json& figures, std::vector<std::string> faults, bool mostly_wrong);

}  // namespace tumblesight::sim
