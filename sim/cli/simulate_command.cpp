#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "hal/dds/idl/development_key.hpp"
#include "hal/dds/idl/domain.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/disturbance_arguments.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/simulate_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/experiment.hpp"
#include "sim/evaluation/float32_reference.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/report/results_tables.hpp"
#include "sim/report/sil_report.hpp"
#include "sim/sil/interruption.hpp"
#include "sim/sil/signed_telecommand.hpp"
#include "sim/terminal/progress.hpp"
#include "sim/terminal/text.hpp"
#include "sim/terminal/write_file.hpp"
#include "sim/world/chaser_navigation.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr double kSlowest = 0.1;
constexpr double kFastest = 1000.0;
constexpr double kManualStart_s = 60.0;  // time for the user to start the flight program
constexpr int kDefaultFlightDomain = 0;  // of a flight program without --domain
constexpr int kRunFailed = 1;
constexpr int kInterrupted = 128;  // and the number of the signal, as a shell reports it
constexpr const char* kNoFlight = "none";
constexpr const char* kFastestPossible = "max";

CLI::Validator speed() {
  const auto check = [](std::string& text) -> std::string {
    if (text == kFastestPossible || number(kSlowest, kFastest)(text).empty()) return {};
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
    throw std::runtime_error(fmt::format("flight program '{}' {}; give its path with --flight", path.string(),
                                         fs::exists(path, error) ? "is not a file" : "does not exist"));
  }
  return path.string();
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

SilSettings sil_settings(const SimulateArguments& arguments, const TargetSetup& setup) {
  SilSettings settings;
  settings.target = arguments.scenario.target;
  settings.model_path = setup.model_path;
  settings.model_crc32 = setup.header.crc32;
  settings.flight_path = flight_path(arguments.flight);
  settings.domain = arguments.domain;
  settings.speed = arguments.speed == kFastestPossible ? 0.0 : std::stod(arguments.speed);
  settings.free_running = arguments.free_running;
  settings.ego_motion = !arguments.scenario.disturbances.no_ego_motion;
  if (!arguments.command_key.empty()) {
    settings.command_key = read_command_key(arguments.command_key);
    settings.flight_arguments = {"--command-key", full_path(arguments.command_key)};
  }
  if (!arguments.security.empty()) settings.security_path = full_path(arguments.security);
  if (arguments.flight == kNoFlight) {
    if (settings.domain < 0) settings.domain = kDefaultFlightDomain;
    settings.step_timeout_s = kManualStart_s;
  }
  return settings;
}

SilRunSetup run_setup(const ScenarioArguments& scenario, const TargetSetup& target,
                      const SilSettings& settings) {
  SilRunSetup setup;
  setup.target = scenario.target;
  setup.mesh_name = target.mesh_name;
  setup.condition = scenario.condition;
  setup.sequences = scenario.sequences;
  setup.frames = scenario.frames;
  setup.disturbances = scenario.disturbances;
  setup.effects = scenario.effects;
  setup.sensor = scenario.sensor.sensor;
  setup.ranges = target.ranges;
  setup.seed = scenario.seed;
  setup.model_path = target.model_path;
  setup.model_crc32 = fmt::format("{:08x}", target.header.crc32);
  setup.projection = target.projection;
  setup.speed = settings.speed;
  setup.free_running = settings.free_running;
  setup.remarks = target.warnings;
  if (settings.command_key == hal::dds::kDevelopmentKey)
    setup.remarks.emplace_back("telecommands are signed with the public development key; give --command-key");
  return setup;
}

void print_results(const RunReport& report, const SilRunResult& run,
                   const std::optional<NumericsComparison>& numerics) {
  if (report.results.empty()) {
    fmt::print("\n  None of the {} was answered, so there are no figures.\n",
               counted(report.steps_planned, "step"));
    return;
  }
  fmt::print("\n{}\n{}\n", terminal_text(transposed(run_errors_table(report))),
             terminal_text(by_frame_table(errors_by_frame(report.results, report.setup.frames))));
  fmt::print("  steps              {}\n", steps_text(run));
  fmt::print("  inference time     median {}, max {}\n", time_text(report.inference_median_us),
             time_text(report.inference_max_us));
  fmt::print("  flight heap        {} allocations after init\n", report.heap_allocations);
  fmt::print("  faults that stood  {}\n", text_of(standing_faults(run)));
  fmt::print("  trace CRC-32       {:08x}\n", report.trace_crc32);
  if (!numerics) return;
  fmt::print("  float32 reference  mean error {}; difference of the attitudes: mean {}, max {}\n",
             degrees_text(numerics->float32.mean_deg), degrees_text(numerics->difference.mean_deg),
             degrees_text(numerics->largest_difference_deg));
}

SilRunResult run_sequences(const ScenarioArguments& scenario, const TargetSetup& target,
                           const SilSettings& settings, Float32Reference& float32) {
  ScenarioSettings sequence_settings = scenario_settings(condition_from(scenario.condition), scenario.frames,
                                                         scenario.target, target.inertia_kg_m2);
  sequence_settings.disturbances = scenario.disturbances;
  sequence_settings.effects = scenario.effects;
  sequence_settings.sensor = scenario.sensor.sensor.settings;
  sequence_settings.ranges = target.ranges;
  std::vector<Sequence> sequences;
  for (std::uint32_t i = 0; i < scenario.sequences; ++i) {
    sequences.push_back(make_sequence(sequence_settings, scenario.seed, i));
  }
  const FlashLidar lidar(observed_bodies(scenario.effects, scenario.target, target.mesh));
  ProgressBar bar("simulating", "frames", std::uint64_t{scenario.sequences} * scenario.frames);
  return run_sil(
      settings, lidar, 1e-3 * target.projection.swath_mm, sequences,
      [&](std::uint32_t done, std::uint32_t) { bar.update(done); },
      [&](const StepResult& step, const gnc::RangeImage& frame) {
        float32.add(
            step.sequence, step.frame_index, step.truth, frame,
            chaser_attitude(step.truth, frame.exposure_time_ns, !scenario.disturbances.no_ego_motion));
      });
}

void announce(const ScenarioArguments& scenario, const TargetSetup& target, const SilSettings& settings) {
  fmt::print("\n  {}, {}, {} of {}, seed {}\n  mesh {}, model {}\n\n", scenario.target, scenario.condition,
             counted(scenario.sequences, "sequence"), counted(scenario.frames, "frame"), scenario.seed,
             target.mesh_name, target.model_path);
  print_sensor(scenario.sensor.sensor, target.ranges);
  const std::string disturbances = to_string(scenario.disturbances);
  if (!disturbances.empty()) fmt::print("  disturbed: {}\n\n", disturbances);
  const std::string effects = to_string(scenario.effects);
  if (!effects.empty()) fmt::print("  effect: {}\n\n", effects);
  if (settings.flight_path.empty()) {
    fmt::print(
        "  Waiting up to {:g} s for the flight program. Unless it is running already, start\n    {}\n\n",
        settings.step_timeout_s, flight_command_line(settings));
  }
  std::fflush(stdout);
  for (const std::string& warning : target.warnings) fmt::print(stderr, "  note: {}\n", warning);
}

void print_advice(const ScenarioArguments& scenario, const TargetSetup& target, const RunReport& report) {
  const std::vector<FrameResult> last = last_frames(report.results, scenario.frames);
  const std::string advice =
      mesh_advice(scenario, {swath_m(target.mesh), 1e-3 * target.projection.swath_mm},
                  last_frame_summary(report.results, scenario.frames, Estimator::kRcnn),
                  common_turn(last, Estimator::kRcnn));
  if (!advice.empty()) fmt::print("\n{}\n", advice);
}

// Writes the report, then the figures, even if one of them cannot be written. Returns the messages of the
// failures.
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
    write_file(arguments.report, run_page(report));
    fmt::print("  report             {}\n", full_path(arguments.report));
  });
  const std::string& json = arguments.scenario.json;
  attempt([&] {
    if (!json.empty()) write_file(json, figures.dump(2) + "\n");
  });
  return failures;
}

void require_usable_files(const SimulateArguments& arguments) {
  const std::string& json = arguments.scenario.json;
  require_different("--json", json, "--report", arguments.report);
  require_writable("--report", arguments.report);
  if (!json.empty()) require_writable("--json", json);
}

void require_a_speed(const SimulateArguments& arguments) {
  if (!arguments.free_running || arguments.speed != kFastestPossible) return;
  throw CLI::ValidationError("--free-running",
                             "needs a speed: --speed 1 for real time, --speed N for N times real time");
}

void simulate(SimulateArguments arguments) {
  const ScenarioArguments& scenario = arguments.scenario;
  require_supported_length(scenario);
  require_a_speed(arguments);
  require_possible_disturbances(scenario.disturbances, scenario.frames);
  if (arguments.report.empty()) arguments.report = default_report(arguments);
  require_usable_files(arguments);
  const TargetSetup target = set_up_target(scenario);
  const SilSettings settings = sil_settings(arguments, target);
  const SilRunSetup setup = run_setup(scenario, target, settings);
  announce(scenario, target, settings);

  Float32Reference float32(target.model_path, target.model, scenario.target);
  std::optional<Interruption> interruption(std::in_place);
  const SilRunResult run = run_sequences(scenario, target, settings, float32);
  interruption.reset();
  std::optional<NumericsComparison> numerics;
  // The reference gets every frame. In a free run the flight program may have missed some.
  const bool same_frames = !arguments.free_running || (run.frames_superseded == 0 && run.steps_missed == 0);
  if (float32 && same_frames) numerics = float32.compare(frame_results(run), scenario.frames);
  RunReport report = run_report(setup, run, numerics);
  report.command = arguments.command_line;
  report.generated = local_time_text();
  print_results(report, run, numerics);
  print_advice(scenario, target, report);
  std::vector<std::string> faults = run_faults(run);
  for (const std::string& failure : write_files(arguments, report, run_json(setup, run, numerics)))
    faults.push_back(failure);
  fmt::print("\n");
  std::fflush(stdout);

  for (const std::string& fault : faults) fmt::print(stderr, "tumblesight: {}\n", fault);
  if (Interruption::signal() != 0) throw CLI::RuntimeError(kInterrupted + Interruption::signal());
  if (!faults.empty()) throw CLI::RuntimeError(kRunFailed);
}

}  // namespace

void add_simulate_command(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand(
      "simulate", "Run the flight program with the simulated sensor over DDS and write a report");
  auto arguments = std::make_shared<SimulateArguments>();
  arguments->command_line = command_line;
  add_target_options(*command, arguments->scenario);
  add_condition_option(*command, arguments->scenario.condition);
  add_sequence_options(*command, arguments->scenario);
  add_model_options(*command, arguments->scenario);
  add_json_option(*command, arguments->scenario.json);
  add_sensor_options(*command, arguments->scenario.sensor);
  add_effect_option(*command, arguments->scenario.effects);
  add_disturbance_options(*command, arguments->scenario.disturbances);
  command
      ->add_option("--speed", arguments->speed,
                   "max: as fast as possible; or N times real time (0.1 to 1000)")
      ->check(speed())
      ->type_name("max|N")
      ->capture_default_str();
  command->add_flag(
      "--free-running", arguments->free_running,
      "the flight program runs on its own timer, not in lockstep; needs --speed N (1: as in flight)");
  command
      ->add_option(
          "--flight", arguments->flight,
          "flight program to start [in the folder of tumblesight]; none: you start it, the command is shown")
      ->check(file_path())
      ->type_name("FILE");
  command
      ->add_option(
          "--command-key", arguments->command_key,
          "file with the key that signs telecommands, 64 hexadecimal digits [the public development key]")
      ->check(existing_file())
      ->type_name("FILE");
  command
      ->add_option("--dds-security", arguments->security,
                   "secures the bus with certificates; hal/dds/make_security writes the file")
      ->check(existing_file())
      ->type_name("FILE");
  limit_whole_number(
      command->add_option("--domain", arguments->domain, "DDS domain [a free one, or 0 with --flight none]"),
      0, hal::dds::kMaxDomain)
      ->type_name("N");
  add_report_option(
      *command, arguments->report,
      " [out/<target>_<condition>_seed<seed>.html, plus every option that is not at its default]");
  command->footer(
      "\nExample: 100 sequences with a degraded sensor, figures to a file\n"
      "  tumblesight simulate --condition degraded --sequences 100 --seed 7 \\\n"
      "      --json figures.json\n\n"
      "The exit status is 0 only if every step was answered, with an attitude where the\n"
      "sensor delivered a new frame, no telecommand was refused, the flight task\n"
      "allocated no heap memory, no other program wrote to the topics of the run and\n"
      "the report was written. Faults that the flight program reports do not count.\n"
      "Ctrl-C ends the run, and the report covers what was done.\n"
      "With --free-running and a sensor that is faster than the cycle, the newest frame\n"
      "of each cycle is used. The frames that it supersedes are counted.\n" +
      disturbance_examples("simulate"));
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace tumblesight::sim
