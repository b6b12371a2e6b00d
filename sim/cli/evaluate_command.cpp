#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "sim/cli/disturbance_arguments.hpp"
#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/symmetry_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/evaluation/chance.hpp"
#include "sim/evaluation/checks.hpp"
#include "sim/evaluation/curves.hpp"
#include "sim/report/results_files.hpp"
#include "sim/report/results_json.hpp"
#include "sim/report/results_tables.hpp"
#include "sim/terminal/progress.hpp"
#include "sim/terminal/text.hpp"
#include "sim/terminal/write_file.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

std::vector<Condition> conditions_of(const EvaluateArguments& arguments) {
  std::vector<Condition> conditions;
  for (const std::string& name : arguments.conditions) {
    const Condition condition = condition_from(name);
    const bool known = std::find(conditions.begin(), conditions.end(), condition) != conditions.end();
    if (known) throw CLI::ValidationError("--condition", fmt::format("'{}' is given twice", name));
    conditions.push_back(condition);
  }
  return conditions;
}

void announce(const Subject& subject, const ExperimentSettings& settings) {
  std::string conditions;
  for (const Condition condition : settings.conditions) {
    conditions += (conditions.empty() ? "" : ", ") + to_string(condition);
  }
  fmt::print("\n  {}, {}, {} of {}, seed {}\n  mesh {}, model {}, CRC-32 {:08x}\n\n", subject.target,
             conditions, counted(settings.sequences, "sequence"), counted(settings.frames, "frame"),
             settings.seed, subject.mesh_name, subject.model_name, subject.model_crc32);
  print_sensor(subject.sensor, subject.ranges);
  print_symmetry(subject.symmetry);
  const std::string disturbances = to_string(settings.disturbances);
  if (!disturbances.empty()) fmt::print("  disturbed: {}\n\n", disturbances);
  const std::string effects = to_string(settings.effects);
  if (!effects.empty()) fmt::print("  effect: {}\n\n", effects);
  std::fflush(stdout);
}

void print_cell(const SubjectResult& subject, const CellResult& cell) {
  if (subject.cells.size() > 1) fmt::print("\n  {}\n", to_string(cell.condition));
  fmt::print("\n{}\n{}\n", terminal_text(transposed(cell_table(subject.target, cell))),
             terminal_text(by_frame_table(cell.by_frame)));
  fmt::print("  network              {:.2f} ms per frame (median, one thread)\n", cell.network_ms);
  if (cell.baseline) {
    fmt::print(
        "  template matching    {:.0f} ms per frame; templates of the same mesh as the frames, last {} "
        "of the first {}\n",
        cell.baseline_ms, cell.baseline->count == 1 ? "frame" : "frames",
        counted(cell.baseline->count, "sequence"));
  }
  if (!cell.peers.empty()) fmt::print("\n{}", terminal_text(transposed(peers_table(cell))));
}

void print_results(const Results& results) {
  const SubjectResult& subject = results.subjects.front();
  for (const CellResult& cell : subject.cells) print_cell(subject, cell);
  const DataTable poses = poses_table(subject);
  if (!poses.rows.empty()) fmt::print("\n{}", terminal_text(transposed(poses)));
  if (!subject.sweeps) return;
  const Sweeps& sweeps = *subject.sweeps;
  fmt::print("\n{}\n{}\n{}\n{}\n", terminal_text(curve_table("range [m]", subject.cells.front().by_range)),
             terminal_text(curve_table("rate, components drawn [deg/s]", subject.cells.front().by_rate)),
             terminal_text(curve_table("rate, norm drawn [deg/s]", sweeps.by_rate_norm)),
             terminal_text(curve_table("hidden [%]", sweeps.by_hidden_share, 100.0)));
  for (const Check& check : checks_of(subject)) {
    fmt::print("  {}: {}{}\n", check.what, text_of(check), check.holds() ? "" : "  MISSED");
  }
}

void write_files(const EvaluateArguments& arguments, const Results& results) {
  const std::string& json = arguments.scenario.json;
  if (!json.empty()) write_file(json, results_json(results).dump(2) + "\n");
  if (!arguments.csv.empty()) write_file(arguments.csv, results_csv(results));
  if (arguments.report.empty()) return;
  write_file(arguments.report, results_page(results));
  fmt::print("  report               {}\n", full_path(arguments.report));
}

// Returns whether there is a condition with mostly wrong attitudes. Says what each has, and what it can mean.
bool print_what_is_wrong(const EvaluateArguments& arguments, const Subject& subject,
                         const SubjectResult& result) {
  const Swaths swaths{swath_m(subject.mesh), subject.swath_m};
  const CellResult* first = nullptr;
  for (const CellResult& cell : result.cells) {
    if (!is_mostly_wrong(cell)) continue;
    fmt::print("\n{}", paragraph(fmt::format("Condition {}: {}", to_string(cell.condition),
                                             mostly_wrong_text(cell.rcnn, cell.symmetry))));
    if (first == nullptr) first = &cell;
  }
  if (first == nullptr) return false;
  fmt::print("{}", mesh_advice(arguments.scenario, swaths, first->rcnn, first->common_turn));
  return true;
}

ExperimentSettings checked_settings(const EvaluateArguments& arguments) {
  ExperimentSettings settings = experiment_settings(arguments);
  settings.conditions = conditions_of(arguments);
  require_supported_length(arguments.scenario);
  require_possible_disturbances(settings.disturbances, settings.frames);
  require_usable_files(
      files_read(arguments.scenario),
      {{"--json", arguments.scenario.json}, {"--csv", arguments.csv}, {"--report", arguments.report}});
  return settings;
}

Subject checked_subject(const EvaluateArguments& arguments, const ExperimentSettings& settings) {
  Subject subject = set_up_subject(arguments.scenario);
  for (const Condition condition : settings.conditions) {
    (void)scenario_settings(condition, settings.frames, subject.target, subject.inertia_kg_m2);
  }
  return subject;
}

void evaluate(const EvaluateArguments& arguments) {
  const ExperimentSettings settings = checked_settings(arguments);
  const std::vector<std::string> left_out =
      settings.peers ? missing_peers(pose_peers()) : std::vector<std::string>{};
  const Subject subject = checked_subject(arguments, settings);
  announce(subject, settings);
  for (const std::string& line : left_out) fmt::print(stderr, "  left out: {}\n", line);

  Results results;
  results.seed = settings.seed;
  results.command = arguments.command_line;
  results.generated = local_time_text();
  ProgressBar bar("evaluating", "steps", steps_of(settings));
  results.subjects.push_back(
      run_experiment(subject, settings, [&](std::uint64_t done) { bar.update(done); }));
  bar.finish();
  print_results(results);
  const bool wrong = print_what_is_wrong(arguments, subject, results.subjects.front());
  write_files(arguments, results);
  fmt::print("\n");
  if (wrong) throw CLI::RuntimeError(kOfNoUse);
}

std::string text_of(const EffectLimit& limit) {
  const std::string range = fmt::format("from {:g} to {:g}: ", limit.from, limit.to);
  if (!limit.holds_at) return range + "at neither end";
  if (!limit.fails_at) return range + "at both ends";
  return range + fmt::format("at {:g}, no longer at {:g}", *limit.holds_at, *limit.fails_at);
}

nlohmann::ordered_json effect_limits_json(const Subject& subject, const ExperimentSettings& settings,
                                          const EffectRow& row, const std::vector<EffectLimit>& limits) {
  nlohmann::ordered_json json{{"effect", row.name},
                              {"unit", row.unit},
                              {"within_20deg_at_least", kEffectBar},
                              {"target", subject.target},
                              {"mesh", subject.mesh_name},
                              {"model", subject.model_name},
                              {"model_crc32", fmt::format("{:08x}", subject.model_crc32)},
                              {"condition", to_string(settings.conditions.front())},
                              {"seed", settings.seed},
                              {"sequences", settings.sequences},
                              {"frames", settings.frames},
                              {"sensor", sensor_json(subject.sensor)},
                              {"ranges_m", {subject.ranges.nearest_m, subject.ranges.farthest_m}},
                              {"other_effects", effect_json(settings.effects)},
                              {"disturbances", disturbances_json(settings.disturbances)}};
  const auto or_null = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  json["limits"] = nlohmann::ordered_json::array();
  for (const EffectLimit& limit : limits) {
    nlohmann::ordered_json trials = nlohmann::ordered_json::array();
    for (const EffectLimit::Trial& trial : limit.trials)
      trials.push_back({{"strength", trial.strength}, {"within_20deg", trial.within_20deg}});
    json["limits"].push_back({{"from", limit.from},
                              {"to", limit.to},
                              {"holds_at", or_null(limit.holds_at)},
                              {"fails_at", or_null(limit.fails_at)},
                              {"trials", trials}});
  }
  return json;
}

void evaluate_effect_limit(const EvaluateArguments& arguments) {
  ExperimentSettings settings = checked_settings(arguments);
  settings.baseline_sequences = 0;
  if (settings.conditions.size() > 1)
    throw CLI::ValidationError("--effect-limit", "is searched under one --condition");
  const EffectRow& row = effect_named(arguments.effect_limit);
  if (settings.effects.*row.strength != 0.0)
    throw CLI::ValidationError(
        "--effect-limit", fmt::format("searches the strength of {0}; leave {0} out of --effect", row.name));
  const Subject subject = checked_subject(arguments, settings);
  announce(subject, settings);
  const auto limits = effect_limits(row, [&](double strength) {
    ExperimentSettings trial = settings;
    trial.effects.*row.strength = strength;
    ProgressBar bar(fmt::format("{}={:g}", row.name, strength), "steps", steps_of(trial));
    const SubjectResult result =
        run_experiment(subject, trial, [&](std::uint64_t done) { bar.update(done); });
    bar.finish();
    const double share = result.cells.front().rcnn.within_20deg;
    fmt::print("  {}={:g}: {:.1f} % within 20°\n", row.name, strength, 100.0 * share);
    std::fflush(stdout);
    return share;
  });
  fmt::print("\n  {:g} % within 20°, {}{}{}:\n", 100.0 * kEffectBar, row.name, *row.unit == '\0' ? "" : ", ",
             row.unit);
  for (const EffectLimit& limit : limits) fmt::print("    {}\n", text_of(limit));
  fmt::print("\n");
  if (arguments.scenario.json.empty()) return;
  write_file(arguments.scenario.json, effect_limits_json(subject, settings, row, limits).dump(2) + "\n");
}

}  // namespace

void add_evaluate_command(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand(
      "evaluate", "Measure the accuracy of a model over many sequences, without the flight program");
  auto arguments = std::make_shared<EvaluateArguments>();
  arguments->command_line = command_line;
  add_evaluate_options(*command, *arguments);
  command->callback([arguments, command] {
    take_period_of_sensor(*command, arguments->scenario);
    if (!arguments->paper) require_a_name(*command, {arguments->scenario.mesh});
    arguments->sequences_given = command->get_option("--sequences")->count() > 0;
    if (!arguments->effect_limit.empty()) {
      refuse_options_of_tables(*command);
      evaluate_effect_limit(*arguments);
    } else if (arguments->paper) {
      refuse_options_set_by_paper(*command);
      evaluate_paper(*arguments);
    } else {
      evaluate(*arguments);
    }
  });
}

}  // namespace tumblesight::sim
