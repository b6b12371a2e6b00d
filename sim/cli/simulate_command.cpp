#include "sim/cli/simulate_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "hal/dds/idl/domain.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/float32_beside.hpp"
#include "sim/cli/sil_results.hpp"
#include "sim/cli/simulate_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/experiment.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/report/results_table.hpp"
#include "sim/sil/telecommand.hpp"
#include "sim/terminal/progress.hpp"
#include "sim/terminal/text_file.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kSlowest = 0.1;
constexpr double kFastest = 1000.0;
constexpr double kTimeToStartFlight_s = 60.0;  // by hand
constexpr int kFlightsOwnDomain = 0;           // unless told otherwise
constexpr int kRunFailed = 1;
constexpr const char* kNoFlight = "none";

CLI::Validator speed() {
  const auto check = [](std::string& text) -> std::string {
    if (text == "max" || number(kSlowest, kFastest)(text).empty()) return {};
    return fmt::format("must be max or a number from {:g} to {:g}, not '{}'", kSlowest, kFastest, text);
  };
  return CLI::Validator(check, "", "speed");
}

std::string default_report(const SimulateArguments& arguments) {
  return fmt::format("{}/out/{}", TUMBLESIGHT_SOURCE_DIR, default_report_name(arguments));
}

fs::path shipped_flight() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "flight";
}

std::string flight_path(const std::string& given) {
  if (given == kNoFlight) return {};
  const fs::path path = given.empty() ? shipped_flight() : fs::path(given);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    throw std::runtime_error(
        fmt::format("flight program '{}' does not exist; name it with --flight", path.string()));
  }
  return path.string();
}

// As one word for a shell.
std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// What the user has to start, for a shell.
std::string flight_command_line(const SilSettings& settings) {
  std::string line =
      fmt::format("{} --domain {} --target {} --model {}", shell_quoted(shipped_flight().string()),
                  settings.domain, settings.target, shell_quoted(full_path(settings.model_path)));
  for (const std::string& argument : settings.flight_arguments) line += " " + shell_quoted(argument);
  if (settings.free_running && settings.speed > 0.0) {
    line += fmt::format(" --mode free-running --period-ms {:g}", 1e3 * kFramePeriod_s / settings.speed);
  }
  return line;
}

SilSettings sil_settings(const SimulateArguments& arguments, const TargetSetup& setup) {
  SilSettings settings;
  settings.target = arguments.scenario.target;
  settings.model_path = setup.model_path;
  settings.flight_path = flight_path(arguments.flight);
  settings.domain = arguments.domain;
  settings.speed = arguments.speed == "max" ? 0.0 : std::stod(arguments.speed);
  settings.free_running = arguments.free_running;
  if (!arguments.command_key.empty()) {
    settings.command_key = read_command_key(arguments.command_key);
    settings.flight_arguments = {"--command-key", full_path(arguments.command_key)};
  }
  if (arguments.flight == kNoFlight) {
    if (settings.domain < 0) settings.domain = kFlightsOwnDomain;
    settings.step_timeout_s = kTimeToStartFlight_s;
  }
  return settings;
}

void print_results(const ScenarioArguments& scenario, const SilRecording& recording,
                   const RunReport& report) {
  const auto summary = [&](Estimator estimator) {
    return summarise(last_frame_errors_deg(report.results, scenario.frames, estimator));
  };
  fmt::print(
      "\n{}\n{}\n",
      cell_table(summary(Estimator::kRcnn), summary(Estimator::kCnn), {}, scenario.frames, report.paper),
      by_frame_table(errors_by_frame(report.results, scenario.frames)));
  fmt::print("  steps            {} of {} answered\n", recording.steps_planned - recording.steps_missed,
             recording.steps_planned);
  fmt::print("  inference time   median {:.2f} ms, max {:.2f} ms\n", 1e-3 * report.inference_median_us,
             1e-3 * report.inference_max_us);
  fmt::print("  flight heap      {} allocations after init\n", recording.flight_heap_allocations);
  fmt::print("  trace CRC-32     {:08x}\n", recording.trace_crc32);
}

void print_numerics(const NumericsComparison& numerics) {
  fmt::print("  float32 beside   mean {}; attitudes differ by {} on average, at most {}\n",
             degrees_text(numerics.float32.mean_deg), degrees_text(numerics.difference.mean_deg),
             degrees_text(numerics.largest_difference_deg));
}

SilRecording record(const SimulateArguments& arguments, const TargetSetup& setup, const SilSettings& settings,
                    Float32Beside& float32) {
  const ScenarioArguments& scenario = arguments.scenario;
  const ScenarioSettings settings_of_sequence = scenario_settings(
      condition_from(scenario.condition), scenario.frames, scenario.target, setup.inertia_kg_m2);
  std::vector<Sequence> sequences;
  for (std::uint32_t i = 0; i < scenario.sequences; ++i) {
    sequences.push_back(make_sequence(settings_of_sequence, scenario.seed, i));
  }
  const FlashLidar lidar(setup.mesh);
  ProgressBar bar("simulating", "frames", std::uint64_t{scenario.sequences} * scenario.frames);
  return run_sil(
      settings, lidar, 1e-3 * setup.projection.swath_mm, sequences,
      [&](std::uint32_t done, std::uint32_t) { bar.update(done); },
      [&](const StepRecord& step, const gnc::RangeImage& frame) { float32.frame_sent(step, frame); });
}

void announce(const ScenarioArguments& scenario, const TargetSetup& setup, const SilSettings& settings) {
  fmt::print("\n  {}, {}, {} sequences of {} frames, seed {}\n  mesh {}, model {}\n\n", scenario.target,
             scenario.condition, scenario.sequences, scenario.frames, scenario.seed, setup.mesh_name,
             setup.model_path);
  if (settings.flight_path.empty()) {
    fmt::print(
        "  Waiting up to {:g} s for the flight program. Unless it is running already, start\n    {}\n\n",
        settings.step_timeout_s, flight_command_line(settings));
  }
  std::fflush(stdout);
  for (const std::string& warning : setup.warnings) fmt::print(stderr, "  note: {}\n", warning);
}

// Report first; a file that cannot be written keeps no other from being written. Returns what went wrong.
std::vector<std::string> write_files(const SimulateArguments& arguments, const RunReport& report,
                                     const nlohmann::ordered_json& figures) {
  std::vector<std::string> failures;
  const auto attempt = [&](const auto& write) {
    try {
      write();
    } catch (const std::exception& error) {
      failures.emplace_back(error.what());
    }
  };
  attempt([&] {
    write_text_file(arguments.report, compose_report(report));
    fmt::print("  report           {}\n", full_path(arguments.report));
  });
  const std::string& json = arguments.scenario.json;
  attempt([&] {
    if (!json.empty()) write_text_file(json, figures.dump(2) + "\n");
  });
  return failures;
}

void simulate(SimulateArguments arguments) {
  const ScenarioArguments& scenario = arguments.scenario;
  require_bearable_length(scenario);
  if (arguments.report.empty()) arguments.report = default_report(arguments);
  require_different("--json", scenario.json, "--report", arguments.report);
  require_writable("--report", arguments.report);
  if (!scenario.json.empty()) require_writable("--json", scenario.json);
  const TargetSetup setup = set_up_target(scenario);
  const SilSettings settings = sil_settings(arguments, setup);

  announce(scenario, setup, settings);

  Float32Beside float32(setup.model_path, setup.model, scenario.target);
  const SilRecording recording = record(arguments, setup, settings, float32);
  RunReport report = run_report(scenario, setup, settings, recording);
  std::optional<NumericsComparison> numerics;
  if (float32) numerics = float32.compare(report.results, scenario.frames);
  if (numerics) report.facts.insert(report.facts.begin() + 1, numerics_facts(*numerics));
  report.command = arguments.command_line;
  report.generated = fmt::format("{:%Y-%m-%d %H:%M %Z}", fmt::localtime(std::time(nullptr)));
  print_results(scenario, recording, report);
  if (numerics) print_numerics(*numerics);
  std::vector<std::string> wrong = shortcomings(recording);
  for (const std::string& failure : write_files(arguments, report, run_json(scenario, recording, numerics)))
    wrong.push_back(failure);
  fmt::print("\n");
  std::fflush(stdout);

  for (const std::string& sentence : wrong) fmt::print(stderr, "tumblesight: {}\n", sentence);
  if (!wrong.empty()) throw CLI::RuntimeError(kRunFailed);
}

}  // namespace

void add_simulate_command(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand(
      "simulate", "Run the flight program against the simulated sensor over DDS, and report");
  auto arguments = std::make_shared<SimulateArguments>();
  arguments->command_line = command_line;
  add_target_options(*command, arguments->scenario);
  add_condition_option(*command, arguments->scenario);
  add_sequence_options(*command, arguments->scenario);
  add_file_options(*command, arguments->scenario);
  command->add_option("--speed", arguments->speed, "max, or N times real time, 0.1 to 1000")
      ->check(speed())
      ->type_name("max|N")
      ->capture_default_str();
  command->add_flag("--free-running", arguments->free_running,
                    "flight on its own timer instead of in lockstep; with --speed 1 as in flight");
  command
      ->add_option("--flight", arguments->flight,
                   "flight program to start [beside tumblesight]; none: you start it, and are shown how")
      ->type_name("FILE");
  command
      ->add_option("--command-key", arguments->command_key,
                   "key that telecommands are signed with, 64 hexadecimal digits [one that everybody knows]")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  command
      ->add_option(
          "--domain", arguments->domain,
          fmt::format("DDS domain, 0 to {} [a free one; 0 with --flight none]", hal::dds::kMaxDomain))
      ->check(whole_number(0, hal::dds::kMaxDomain))
      ->type_name("N");
  command
      ->add_option(
          "--report", arguments->report,
          "HTML report [out/<target>_<condition>_seed<seed>.html, with what else is not at its default]")
      ->type_name("FILE");
  command->footer(
      "\nExample: 100 sequences with a degraded sensor, figures to a file\n"
      "  tumblesight simulate --condition degraded --sequences 100 --seed 7 --json figures.json\n\n"
      "The exit status is 0 only if every step was answered with an attitude, the flight task\n"
      "left the heap alone and the report was written.\n");
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace tumblesight::sim
