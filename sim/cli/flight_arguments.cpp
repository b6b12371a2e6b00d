#include "sim/cli/flight_arguments.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "hal/dds/idl/development_key.hpp"
#include "hal/dds/idl/domain.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/host/input_file.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/operations/signed_telecommand.hpp"
#include "sim/recording/run_file.hpp"
#include "sim/world/scenario/disturbance.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kSlowest = 0.1;
constexpr double kFastest = 1000.0;
constexpr double kManualStart_s = 60.0;  // time for the user to start the flight program
constexpr int kDefaultFlightDomain = 0;  // of a flight program without --domain
constexpr int kInterrupted = 128;        // and the number of the signal, as a shell reports it
constexpr const char* kNoFlight = "none";

ValueCheck speed() {
  const auto check = [](std::string& text) -> std::string {
    if (text == kFastestPossible || number(kSlowest, kFastest).fault_of(text).empty()) return {};
    return fmt::format("must be max or a number from {:g} to {:g}, not '{}'", kSlowest, kFastest, text);
  };
  return ValueCheck{check, "speed"};
}

fs::path shipped_flight() {
  return program_path().parent_path() / "flight";
}

std::string flight_path(const std::string& given) {
  if (given == kNoFlight) return {};
  const fs::path path = given.empty() ? shipped_flight() : fs::path(given);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    throw std::runtime_error(fmt::format("flight program '{}' {}; give its path with --flight", path.string(),
                                         fs::exists(path, error) ? "is not a file" : "does not exist"));
  }
  if (access(path.c_str(), X_OK) != 0)
    throw std::runtime_error(
        fmt::format("flight program '{}' cannot be started: {}; give an executable one with --flight",
                    path.string(), std::strerror(errno)));
  return path.string();
}

// Keys and certificates, as in <PrivateKey>file:/path/key.pem</PrivateKey>.
std::vector<std::string> files_of_security(const std::string& path) {
  if (path.empty()) return {};
  constexpr InputKind kSecurity{"file of --dds-security", sizeof hal::dds::SecurityElement::text};
  const std::string text = read_text(path, kSecurity), scheme = ">file:";
  std::vector<std::string> files;
  for (std::size_t at = text.find(scheme); at != std::string::npos; at = text.find(scheme, at)) {
    at += scheme.size();
    files.push_back(text.substr(at, text.find('<', at) - at));
  }
  return files;
}

// One word for a shell, whatever it contains.
std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// The command that the user has to run, for a shell.
std::string flight_command_line(const SilSettings& settings) {
  std::string line =
      fmt::format("{} --domain {} --target {} --model {}", shell_quoted(shipped_flight().string()),
                  settings.domain, settings.target, shell_quoted(full_path(settings.model_path)));
  if (!settings.security_path.empty()) line += " --dds-security " + shell_quoted(settings.security_path);
  for (const std::string& argument : settings.flight_arguments) line += " " + shell_quoted(argument);
  if (settings.free_running && settings.speed > 0.0) {
    line += fmt::format(" --mode free-running --period-ms {:g}", 1e3 * kFramePeriod_s / settings.speed);
  }
  return line;
}

// False also if the file could not be written, whatever else is there.
bool is_recording_of_a_run(const std::string& path) {
  return !path.empty() && RunFile::is_one(path);
}

}  // namespace

void add_flight_options(Command& command, FlightArguments& arguments) {
  command
      .add_option("--speed", arguments.speed, "max: as fast as possible; or N times real time (0.1 to 1000)")
      ->check(speed())
      ->type_name("max|N")
      ->capture_default_str();
  command
      .add_option(
          "--flight", arguments.flight,
          "flight program to start [in the folder of tumblesight]; none: you start it, the command is shown")
      ->check(file_path())
      ->type_name("FILE");
  command
      .add_option(
          "--command-key", arguments.command_key,
          "file with the key that signs telecommands, 64 hexadecimal digits [the public development key]")
      ->check(existing_file())
      ->type_name("FILE");
  command
      .add_option("--dds-security", arguments.security,
                  "secures the bus with certificates; hal/dds/make_security writes the file")
      ->check(existing_file())
      ->type_name("FILE");
  command
      .add_option(
          "--mcap", arguments.mcap,
          "also records the run for Foxglove, Lichtblick or PlotJuggler: every sample of the bus, the "
          "points, frames and events that they show, and errors to plot")
      ->check(file_path())
      ->type_name("FILE");
  limit_whole_number(
      command.add_option("--domain", arguments.domain, "DDS domain [a free one, or 0 with --flight none]"), 0,
      hal::dds::kMaxDomain)
      ->type_name("N");
}

SilSettings sil_settings(const FlightArguments& arguments, const std::string& target,
                         const TargetSetup& setup) {
  SilSettings settings;
  settings.target = target;
  settings.model_path = setup.model_path;
  settings.model_crc32 = setup.header.crc32;
  settings.flight_path = flight_path(arguments.flight);
  settings.domain = arguments.domain;
  settings.speed = arguments.speed == kFastestPossible ? 0.0 : std::stod(arguments.speed);
  settings.free_running = arguments.free_running;
  if (!arguments.command_key.empty()) {
    settings.command_key = read_command_key(arguments.command_key);
    settings.flight_arguments = {"--command-key", full_path(arguments.command_key)};
  }
  if (!arguments.security.empty()) settings.security_path = full_path(arguments.security);
  settings.mcap_path = arguments.mcap;
  settings.swath_m = 1e-3 * setup.projection.swath_mm;
  if (arguments.flight == kNoFlight) {
    if (settings.domain < 0) settings.domain = kDefaultFlightDomain;
    settings.step_timeout_s = kManualStart_s;
  }
  return settings;
}

FlightSetup flight_setup(const std::string& target, const TargetSetup& setup, const SilSettings& settings) {
  FlightSetup described;
  described.target = target;
  described.model_path = setup.model_path;
  described.model_crc32 = fmt::format("{:08x}", setup.header.crc32);
  described.projection = setup.projection;
  described.speed = settings.speed;
  described.free_running = settings.free_running;
  described.remarks = setup.warnings;
  if (settings.command_key == hal::dds::kDevelopmentKey)
    described.remarks.emplace_back(
        "telecommands are signed with the public development key; give --command-key");
  return described;
}

void require_usable_outputs(const FlightArguments& arguments, OptionFiles read, const std::string& json) {
  if (arguments.flight != kNoFlight) read.push_back({"--flight", arguments.flight});
  read.push_back({"--command-key", arguments.command_key});
  read.push_back({"--dds-security", arguments.security});
  for (const std::string& file : files_of_security(arguments.security))
    read.push_back({"--dds-security (a file that it names)", file});
  require_usable_files(read, {{"--report", arguments.report}, {"--json", json}, {"--mcap", arguments.mcap}});
}

std::string default_report_path(const std::string& name) {
  return program_files().output + "/" + name;
}

void announce_flight(const SilSettings& settings, const TargetSetup& setup) {
  if (settings.flight_path.empty()) {
    fmt::print(
        "  Waiting up to {:g} s for the flight program. Unless it is running already, start\n    {}\n\n",
        settings.step_timeout_s, flight_command_line(settings));
  }
  std::fflush(stdout);
  for (const std::string& warning : setup.warnings) print_note(warning);
}

void finish_flight(const FlightArguments& arguments, const std::string& page, const std::string& json,
                   const nlohmann::ordered_json& figures, std::vector<std::string> faults,
                   bool mostly_wrong) {
  const auto attempt = [&](const auto& write) {
    try {
      write();
    } catch (const std::exception& error) {
      faults.emplace_back(error.what());
    }
  };
  attempt([&] {
    write_file(arguments.report, page);
    fmt::print("  report             {}\n", full_path(arguments.report));
  });
  if (is_recording_of_a_run(arguments.mcap))
    fmt::print("  recording          {}\n", full_path(arguments.mcap));
  attempt([&] {
    if (!json.empty()) write_file(json, figures.dump(2) + "\n");
  });
  fmt::print("\n");
  std::fflush(stdout);
  for (const std::string& fault : faults) print_message("tumblesight: " + fault);
  if (Interruption::signal() != 0) throw Exit(kInterrupted + Interruption::signal());
  if (!faults.empty()) throw Exit(kFailed);
  if (mostly_wrong) throw Exit(kOfNoUse);
}

}  // namespace tumblesight::sim
