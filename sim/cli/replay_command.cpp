#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "gnc/numerics/crc.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/flight_arguments.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/mission_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/recording/recorded_steps.hpp"
#include "sim/recording/recording_file.hpp"
#include "sim/recording/run_steps.hpp"
#include "sim/report/replay_report.hpp"
#include "sim/report/sil_report.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoTruth = "none";
constexpr std::size_t kMaxLines = 200;  // of the table on the terminal; report and figures have all cycles

struct ReplayArguments : FlightArguments {
  ScenarioArguments scenario;  // of which only target, model, numerics and figures have options
  std::string recording;
  std::string truth;  // empty: the one beside the recording, if there is one
  bool is_target_given = false;
};

// Empty: there is none.
std::string truth_path(const ReplayArguments& arguments) {
  if (arguments.truth == kNoTruth) return {};
  if (!arguments.truth.empty()) return arguments.truth;
  const std::string beside = truth_path_of(arguments.recording);
  std::error_code error;
  return fs::is_regular_file(beside, error) ? beside : std::string();
}

OptionFiles files_read(const ReplayArguments& arguments, const std::string& truth) {
  OptionFiles files = files_read(arguments.scenario);
  files.push_back({"RECORDING", arguments.recording});
  files.push_back({"--truth", truth});
  return files;
}

// What the file of truth says about the frames need not be what the flight program looks for.
std::vector<std::string> remarks_on(const TruthTable& truth, const std::string& file,
                                    const std::string& target, const std::string& model) {
  std::vector<std::string> remarks;
  const auto other = std::find_if(truth.begin(), truth.end(), [&](const auto& row) {
    return !row.second.target.empty() && row.second.target != target;
  });
  if (other != truth.end())
    remarks.push_back(
        fmt::format("The truth in '{0}', line {1}, is of target {2}, and the flight program looks for {3}. "
                    "The errors mean "
                    "nothing unless both have the same axes; --target {2} looks for that of the truth.",
                    file, other->second.line, other->second.target, target));
  const std::string sensor_file = sensor_file_of(model);
  std::error_code error;
  const bool known = fs::exists(sensor_file, error);
  const SensorDescription trained = known ? sensor_named(sensor_file) : SensorDescription{};
  const auto foreign = std::find_if(truth.begin(), truth.end(), [&](const auto& row) {
    return row.second.sensor && row.second.sensor->crc32 != crc32_of(trained);
  });
  if (foreign != truth.end())
    remarks.push_back(fmt::format(
        "The frames are of sensor {} (CRC-32 {:08x}), and {}.", foreign->second.sensor->name,
        foreign->second.sensor->crc32,
        known ? "the network was trained for sensor " + to_string(trained)
              : fmt::format(
                    "no {} says for which sensor the network was trained; the shipped ones were trained "
                    "for the paper's",
                    fs::path(sensor_file).filename().string())));
  return remarks;
}

// `tumblesight record` names the sensor of every frame, and the target only where the frames show it.
bool shows_another_body(const TruthTable& truth) {
  return !truth.empty() && std::all_of(truth.begin(), truth.end(), [](const auto& row) {
    return row.second.sensor && row.second.target.empty();
  });
}

void announce(const ReplayArguments& arguments, const ReplaySetup& setup, std::size_t known) {
  fmt::print("\n  {}: {} as {}, model {}\n", setup.recording, counted(setup.frames, "frame"), setup.target,
             setup.model_path);
  if (setup.truth.empty()) {
    fmt::print("  truth: {}\n\n", arguments.truth == kNoTruth
                                      ? kNoTruth
                                      : "none beside the recording (" + truth_path_of(setup.recording) +
                                            "); --truth names another");
  } else {
    fmt::print("  truth: {}{}, of {} of the {}\n\n", setup.truth,
               arguments.truth.empty() ? " (beside the recording)" : "", known,
               counted(setup.frames, "frame"));
  }
}

void print_results(const ReplayReport& report, const SilRunResult& run) {
  DataTable cycles = replay_table(report);
  const std::size_t lines = cycles.rows.size();
  cycles.rows.resize(std::min(lines, kMaxLines));
  fmt::print("{}\n", terminal_text(cycles));
  if (lines > kMaxLines)
    fmt::print("  … and {} more lines, which the report and --json have\n\n", lines - kMaxLines);
  const DataTable errors = replay_errors_table(report);
  if (!errors.rows.empty()) fmt::print("{}\n", terminal_text(errors));
  FactList facts = replay_facts(report);
  facts.facts.emplace_back("steps", steps_text(run));
  facts.facts.emplace_back("inference time",
                           fmt::format("median {}, max {}", time_text(report.run.inference_median_us),
                                       time_text(report.run.inference_max_us)));
  facts.facts.emplace_back("flight heap",
                           fmt::format("{} allocations after init", report.run.heap_allocations));
  facts.facts.emplace_back("faults that stood", text_of(standing_faults(run)));
  if (!run.requests.empty()) facts.facts.emplace_back("requests", text_of(run.requests));
  facts.facts.emplace_back("trace CRC-32", fmt::format("{:08x}", report.run.trace_crc32));
  for (const auto& [name, value] : facts.facts)
    fmt::print("  {}{}{}\n", name, std::string(19 - std::min<std::size_t>(18, columns_of(name)), ' '), value);
}

// Runs the flight program over the steps, and writes what came of it. `check`: gives further faults of the
// run.
void run_and_report(const ReplayArguments& arguments, const SilSettings& settings, const ReplaySetup& setup,
                    StepSource& steps,
                    const std::function<std::vector<std::string>(const SilRunResult&)>& check) {
  std::vector<ReplayedFrame> frames;
  ProgressBar bar("replaying", "cycles", steps.steps());
  std::optional<Interruption> interruption(std::in_place);
  const SilRunResult run = run_sil(
      settings, steps, [&](std::uint32_t done, std::uint32_t) { bar.update(done); },
      [&](const StepResult& step, const gnc::RangeImage& frame) {
        frames.push_back(replayed_frame(step, frame));
      });
  interruption.reset();
  bar.finish();
  ReplayReport report = replay_report(setup, run, frames);
  report.run.command = arguments.command_line;
  if (!arguments.mcap.empty())
    report.run.recording = full_path(arguments.mcap);
  else if (RunFile::is_one(arguments.recording))
    report.run.recording = full_path(arguments.recording);
  report.run.generated = local_time_text();
  print_results(report, run);
  std::vector<std::string> faults = flight_faults(run);
  for (std::string& fault : check(run)) faults.push_back(std::move(fault));
  std::string wrong = mostly_wrong_text(report);
  if (wrong.empty()) wrong = nothing_accepted_text(report);
  if (!wrong.empty()) fmt::print("\n{}\n", paragraph(wrong));
  finish_flight(arguments, replay_page(report), arguments.scenario.json, replay_json(report, run),
                std::move(faults), !wrong.empty());
}

// Compares the states of the flight program with those of the recorded run, step by step.
std::vector<std::string> compare_states(const RunSteps& steps, const SilRunResult& run, bool is_same_model) {
  std::size_t same = 0, compared = 0;
  std::optional<std::uint32_t> first;
  for (std::uint32_t k = 0; k < run.steps.size(); ++k) {
    if (!run.steps[k].answered || !steps.state_crc32(k)) continue;
    ++compared;
    const bool is_same = run.steps[k].state_crc32 == *steps.state_crc32(k);
    if (is_same) ++same;
    if (!is_same && !first) first = k;
  }
  fmt::print("  states             {} of {} as recorded\n", same, compared);
  if (!first || !is_same_model) return {};
  // A fault that was asked for while it ran is why the states differ.
  if (!run.requests.empty() && *first >= run.requests.front().step) return {};
  return {
      fmt::format("the state of the flight program differs from the recorded one from step {} on: is it of "
                  "another version, or --command-key another?",
                  *first)};
}

// A run that simulate or replay recorded, with its telecommands.
void replay_run(const ReplayArguments& given) {
  ReplayArguments arguments = given;
  if (!arguments.truth.empty())
    throw ArgumentFault("--truth", "is of recordings of frames; this one of a run has its own truth");
  require_usable_outputs(arguments, files_read(arguments, {}), arguments.scenario.json);
  RunSteps steps(arguments.recording);
  if (steps.target() != arguments.scenario.target) {
    if (arguments.is_target_given)
      throw ArgumentFault("--target", fmt::format("{}: the recorded run is of {}", arguments.scenario.target,
                                                  steps.target()));
    arguments.scenario.target = steps.target();
  }
  const TargetSetup target = set_up_model_alone(arguments.scenario);
  const SilSettings settings = sil_settings(arguments, arguments.scenario.target, target);
  const bool is_same_model = !steps.has_flown() || steps.model_crc32() == target.header.crc32;
  ReplaySetup setup;
  static_cast<FlightSetup&>(setup) = flight_setup(arguments.scenario.target, target, settings);
  setup.recording = arguments.recording;
  setup.truth = arguments.recording;
  setup.frames = steps.frames();
  fmt::print("\n  {}: {}{} and {}, as {}, model {}\n", setup.recording, steps.has_flown() ? "a run of " : "",
             counted(steps.steps(), "step"), counted(setup.frames, "frame"), setup.target, setup.model_path);
  if (!steps.is_whole()) fmt::print("  The recording has no end: its writer was killed.\n");
  if (!is_same_model)
    fmt::print("  The run had another model image (CRC-32 {:08x}), so that the states differ.\n",
               steps.model_crc32());
  fmt::print("\n");
  announce_flight(settings, target);
  run_and_report(arguments, settings, setup, steps, [&](const SilRunResult& run) {
    return steps.has_flown() ? compare_states(steps, run, is_same_model) : std::vector<std::string>();
  });
}

// Recordings of one name in two folders have two reports.
std::string replay_report_name(const std::string& recording) {
  const std::string path = full_path(recording);
  return fmt::format("{}_{:08x}_replay.html", recording_stem(fs::path(path).filename().string()),
                     gnc::crc32(reinterpret_cast<const std::uint8_t*>(path.data()), path.size()));
}

void replay(ReplayArguments arguments) {
  if (arguments.report.empty())
    arguments.report = default_report_path(replay_report_name(arguments.recording));
  if (RunFile::is_one(arguments.recording)) return replay_run(arguments);
  const std::string truth_file = truth_path(arguments);
  require_usable_outputs(arguments, files_read(arguments, truth_file), arguments.scenario.json);
  const RecordingFile recording = read_recording(arguments.recording);
  const TruthTable rows = truth_file.empty() ? TruthTable{} : read_truth(truth_file);
  std::vector<std::optional<RecordedTruth>> truth;
  if (!truth_file.empty()) truth = truth_by_frame(recording, rows, truth_file);
  TargetSetup target = set_up_model_alone(arguments.scenario);
  RecordedSteps steps(recording, truth, 1e-3 * target.projection.swath_mm);
  target.warnings = remarks_on(rows, truth_file, arguments.scenario.target, target.model_path);
  const SilSettings settings = sil_settings(arguments, arguments.scenario.target, target);

  ReplaySetup setup;
  static_cast<FlightSetup&>(setup) = flight_setup(arguments.scenario.target, target, settings);
  setup.recording = arguments.recording;
  setup.truth = truth_file;
  setup.shows_target = !shows_another_body(rows);
  setup.frames = static_cast<std::uint32_t>(recording.frames.size());
  const auto known =
      std::count_if(truth.begin(), truth.end(), [](const auto& row) { return row.has_value(); });
  announce(arguments, setup, static_cast<std::size_t>(known));
  announce_flight(settings, target);

  run_and_report(arguments, settings, setup, steps,
                 [](const SilRunResult&) { return std::vector<std::string>(); });
}

}  // namespace

void add_replay_command(Command& app, const std::string& command_line) {
  Command command = add_verb(app, "replay");
  auto arguments = std::make_shared<ReplayArguments>();
  arguments->command_line = command_line;
  command
      .add_option("RECORDING", arguments->recording,
                  "frames, as `tumblesight record` or a program of your own writes them; or an MCAP "
                  "file of simulate --mcap or record --mcap")
      ->required()
      ->check(existing_file())
      ->type_name("FILE");
  command
      .add_option("--truth", arguments->truth,
                  "true attitudes of the frames; none: not known [FRAMES.truth.csv beside the recording, if "
                  "there is one]")
      ->check(file_path())
      ->type_name("FILE");
  add_target_option(command, arguments->scenario.target, TargetChoice::kWithModel);
  add_mission_option(command, arguments->scenario);
  add_model_options(command, arguments->scenario);
  add_json_option(command, arguments->scenario.json);
  add_flight_options(command, *arguments);
  add_report_option(command, arguments->report,
                    fmt::format(" [out/<recording>_<CRC-32 of its path>_replay.html of {}]",
                                program_files().output_parent));
  command.footer(
      "\nThe flight program gets one cycle per frame, at its exposure time, and a cycle\n"
      "without a frame wherever one is missing for 2.7 s. It sees nothing of the truth.\n"
      "docs/icd.md describes recording, truth, and what a frame must be like;\n"
      "docs/examples/write_recording.py writes one from data of your own.\n\n"
      "A recording of a run has its telecommands, too, and the state of the flight\n"
      "program after each step: the replay must come to the same states, or its exit\n"
      "status is 1.\n\n"
      "Example: frames of your own, as those of a target with a network of your own\n"
      "  tumblesight replay frames.tslr --truth truth.csv --target mine \\\n"
      "      --model mine.tsm\n\n"
      "The exit status is 0 if every cycle was answered, the flight task allocated no\n"
      "heap memory and the files were written: refused frames and doubtful attitudes\n"
      "are results. It is 4 if more than half of the attitudes whose truth is known are\n"
      "more than 20° off, or if all frames were refused for what they hold, except\n"
      "where the recording is known to show another body. It is 1 if the run or a\n"
      "file failed, 2 for wrong arguments, and 130 or 143 after Ctrl-C or SIGTERM; then\n"
      "the report covers what was done.\n");
  command.callback([arguments, command] {
    arguments->is_target_given = command.count("--target") > 0;
    replay(*arguments);
  });
}

}  // namespace tumblesight::sim
