#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sim/cli/arguments.hpp"
#include "sim/cli/disturbance_arguments.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/simulate_arguments.hpp"
#include "sim/cli/symmetry_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/float32_reference.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/experiment/experiment.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/report/error_tables.hpp"
#include "sim/report/sil_report.hpp"
#include "sim/world/chaser_navigation.hpp"

namespace tumblesight::sim {
namespace {

SilRunSetup run_setup(const SimulateArguments& arguments, const TargetSetup& target,
                      const SilSettings& settings) {
  const ScenarioArguments& scenario = arguments.scenario;
  SilRunSetup setup;
  static_cast<FlightSetup&>(setup) = flight_setup(scenario.target, target, settings);
  setup.mesh_name = target.mesh_name;
  setup.condition = scenario.condition;
  setup.sequences = scenario.sequences;
  setup.only = arguments.only;
  setup.frames = scenario.frames;
  static_cast<RunConditions&>(setup) = {scenario.disturbances, scenario.effects, scenario.sensor.sensor,
                                        target.ranges, scenario.symmetry};
  setup.seed = scenario.seed;
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
  const DataTable poses = run_poses_table(report);
  if (!poses.rows.empty()) fmt::print("{}\n", terminal_text(transposed(poses)));
  fmt::print("  steps              {}\n", steps_text(run));
  fmt::print("  inference time     median {}, max {}\n", time_text(report.inference_median_us),
             time_text(report.inference_max_us));
  fmt::print("  flight heap        {} allocations after init\n", report.heap_allocations);
  fmt::print("  faults that stood  {}\n", text_of(standing_faults(run)));
  if (!run.requests.empty()) fmt::print("  requests           {}\n", text_of(run.requests));
  fmt::print("  trace CRC-32       {:08x}\n", report.trace_crc32);
  if (!numerics || numerics->float32.count == 0) return;
  fmt::print("  float32 reference  mean error {}; difference of the attitudes: mean {}, max {}\n",
             degrees_text(numerics->float32.mean_deg), degrees_text(numerics->difference.mean_deg),
             degrees_text(numerics->largest_difference_deg));
}

std::vector<Sequence> sequences_of(const SimulateArguments& arguments, const ScenarioSettings& settings) {
  std::vector<Sequence> sequences;
  for (std::uint32_t i = 0; i < arguments.scenario.sequences; ++i) {
    const std::uint32_t index = arguments.only.empty() ? i : arguments.only[i];
    sequences.push_back(make_sequence(settings, arguments.scenario.seed, index));
  }
  return sequences;
}

SilRunResult run_sequences(const SimulateArguments& arguments, const TargetSetup& target,
                           const SilSettings& settings, Float32Reference& float32) {
  const ScenarioArguments& scenario = arguments.scenario;
  const std::vector<Sequence> sequences = sequences_of(arguments, scenario_settings(scenario, target));
  std::vector<TriangleMesh> bodies = observed_bodies(scenario.effects, scenario.target, target.mesh);
  for (TriangleMesh& body : bodies) mark_panels(body);  // for faults that come while the run goes on
  const FlashLidar lidar(bodies);
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
  print_symmetry(scenario.symmetry);
  const std::string disturbances = to_string(scenario.disturbances);
  if (!disturbances.empty()) fmt::print("  disturbed: {}\n\n", disturbances);
  const std::string effects = to_string(scenario.effects);
  if (!effects.empty()) fmt::print("  effect: {}\n\n", effects);
  announce_flight(settings, target);
}

// What the attitudes are if most of them are wrong, and what it can mean.
void print_what_is_wrong(const ScenarioArguments& scenario, const TargetSetup& target,
                         const RunReport& report) {
  const std::string wrong = mostly_wrong_text(report);
  if (wrong.empty()) return;
  const std::vector<FrameResult> last = last_frames(report.results, scenario.frames);
  const std::string advice =
      mesh_advice(scenario, {swath_m(target.mesh), 1e-3 * target.projection.swath_mm},
                  last_frame_summary(report.results, scenario.frames, Estimator::kRcnn),
                  common_turn(last, Estimator::kRcnn));
  fmt::print("\n{}{}\n", paragraph(wrong), advice);
}

void require_a_speed(const SimulateArguments& arguments) {
  if (!arguments.free_running || arguments.speed != kFastestPossible) return;
  throw ArgumentFault("--free-running",
                      "needs a speed: --speed 1 for real time, --speed N for N times real time");
}

void take_only(SimulateArguments& arguments) {
  if (arguments.only.empty()) return;
  std::vector<std::uint32_t> sorted = arguments.only;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) throw ArgumentFault("--only", fmt::format("{} is given twice", *twice));
  arguments.scenario.sequences = static_cast<std::uint32_t>(arguments.only.size());
}

void simulate(SimulateArguments arguments) {
  take_only(arguments);
  const ScenarioArguments& scenario = arguments.scenario;
  require_supported_length(scenario);
  require_a_speed(arguments);
  require_possible_disturbances(scenario.disturbances, scenario.frames);
  if (arguments.report.empty()) arguments.report = default_report_path(default_report_name(arguments));
  require_usable_outputs(arguments, files_read(scenario), scenario.json);
  const TargetSetup target = set_up_target(scenario);
  SilSettings settings = sil_settings(arguments, scenario.target, target);
  settings.ego_motion = !scenario.disturbances.no_ego_motion;
  const SilRunSetup setup = run_setup(arguments, target, settings);
  announce(scenario, target, settings);

  Float32Reference float32(target.model_path, target.model, scenario.target);
  std::optional<Interruption> interruption(std::in_place);
  const SilRunResult run = run_sequences(arguments, target, settings, float32);
  interruption.reset();
  std::optional<NumericsComparison> numerics;
  // The reference gets every frame, and no telecommand. In a free run the flight program may have missed
  // some.
  const bool same_frames = run.requests.empty() &&
                           (!arguments.free_running || (run.frames_superseded == 0 && run.steps_missed == 0));
  if (float32 && same_frames)
    numerics = float32.compare(frame_results(run, 1e-3 * target.projection.swath_mm), scenario.frames,
                               scenario.symmetry);
  RunReport report = run_report(setup, run, numerics);
  report.command = arguments.command_line;
  if (!arguments.mcap.empty()) report.recording = full_path(arguments.mcap);
  report.generated = local_time_text();
  print_results(report, run, numerics);
  print_what_is_wrong(scenario, target, report);
  finish_flight(arguments, run_page(report), scenario.json, run_json(setup, run, numerics), run_faults(run),
                !mostly_wrong_text(report).empty());
}

}  // namespace

void add_simulate_command(Command& app, const std::string& command_line) {
  Command command = add_verb(app, "simulate");
  auto arguments = std::make_shared<SimulateArguments>();
  arguments->command_line = command_line;
  add_target_options(command, arguments->scenario);
  add_condition_option(command, arguments->scenario.condition);
  add_sequence_options(command, arguments->scenario);
  command
      .add_option("--only", arguments->only,
                  "run these sequences, by their index from 0, in place of the first ones: those that "
                  "`evaluate` or a campaign lists as the worst")
      ->delimiter(',')
      ->check(whole_number(0, 9'999'999))
      ->excludes(command.get_option("--sequences"))
      ->type_name("I,...");
  add_model_options(command, arguments->scenario);
  add_json_option(command, arguments->scenario.json);
  add_sensor_options(command, arguments->scenario.sensor);
  add_effect_option(command, arguments->scenario.effects);
  add_symmetry_option(command, arguments->scenario.symmetry);
  add_disturbance_options(command, arguments->scenario.disturbances);
  add_flight_options(command, *arguments);
  command.add_flag(
      "--free-running", arguments->free_running,
      "the flight program runs on its own timer, not in lockstep; needs --speed N (1: as in flight)");
  add_report_option(
      command, arguments->report,
      fmt::format(
          " [out/<target>_<condition>_seed<seed>.html of {}, plus every option that is not at its default]",
          program_files().output_parent));
  command.footer(
      "\nExample: 100 sequences with a degraded sensor, figures to a file\n"
      "  tumblesight simulate --condition degraded --sequences 100 --seed 7 \\\n"
      "      --json figures.json\n\n"
      "The exit status is 0 only if every step was answered, with an attitude where the\n"
      "sensor delivered a new frame, no telecommand was refused, the flight task\n"
      "allocated no heap memory, no other program wrote to the topics of the run and\n"
      "the report was written. Faults that the flight program reports do not count.\n"
      "Otherwise it is 1, or 2 for wrong arguments. It is 4 if all that holds and more\n"
      "than half of the attitudes in the last frame are more than 20° off, except with\n"
      "the effects that show another body.\n"
      "After Ctrl-C or SIGTERM it is 130 or 143, and the report covers what was done.\n"
      "With --free-running and a sensor that is faster than the cycle, the newest frame\n"
      "of each cycle is used. The frames that it supersedes are counted.\n" +
      disturbance_examples("simulate"));
  command.callback([arguments, command] {
    take_period_of_sensor(command, arguments->scenario);
    require_a_name(command, {arguments->scenario.mesh});
    simulate(*arguments);
  });
}

}  // namespace tumblesight::sim
