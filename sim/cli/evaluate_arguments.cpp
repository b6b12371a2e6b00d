#include "sim/cli/evaluate_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "sim/campaign/shard_file.hpp"
#include "sim/cli/command_line.hpp"
#include "sim/cli/disturbance_arguments.hpp"
#include "sim/cli/symmetry_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kMaxThreads = 1024;
constexpr std::uint64_t kMostInShards = 10'000'000;  // of which each shard is in memory one by one

void add_run_options(Command& command, EvaluateArguments& arguments) {
  command.add_flag(
      "--curves", arguments.curves,
      "also run sweeps: rate drawn by its norm, hidden share, runs of 200 frames; takes seven times as long");
  CommandOption none = command.add_flag("--no-baseline", arguments.no_baseline, "without template matching");
  limit_whole_number(
      command.add_option("--baseline-sequences", arguments.baseline_sequences,
                         "number of sequences whose last frame also goes to template matching"),
      1, 100'000)
      ->type_name("N")
      ->capture_default_str()
      ->excludes(none);
  limit_whole_number(
      command.add_option("--threads", arguments.threads,
                         "worker threads, 0: one per core; the figures do not depend on their number"),
      0, kMaxThreads)
      ->type_name("N")
      ->capture_default_str();
}

// In place of the tables, too.
void add_shard_options(Command& command, EvaluateArguments& arguments) {
  CommandOption shard = command.add_option(
      "--shard", arguments.shard,
      "run only part I of N of the sequences, I from 0, and write their results to --shard-file; "
      "`tumblesight merge` makes the figures of all parts");
  shard->check(shard_text())->type_name("I/N");
  CommandOption file =
      command.add_option("--shard-file", arguments.shard_file,
                         "file of the results of a shard; a run that was stopped goes on in it");
  file->check(file_path())->type_name("FILE")->needs(shard);
  shard->needs(file);
}

// In place of the tables. What must show the target is not an effect whose limit can be searched.
void add_effect_limit_option(Command& command, EvaluateArguments& arguments) {
  std::vector<std::string> names;
  for (const EffectRow& row : effect_table()) {
    const bool shows_target = row.strength != &Effects::wrong_object && row.strength != &Effects::sphere;
    // Strengths that depend on the mesh or on the sensor's period have no common end to begin from.
    const bool has_one_end = row.strength != &Effects::part_missing && row.strength != &Effects::scan_time;
    if (shows_target && has_one_end) names.emplace_back(row.name);
  }
  command
      .add_option("--effect-limit", arguments.effect_limit,
                  "search the strength of this effect up to which 95 % of the sequences are within 20°; "
                  "one run per strength, without tables")
      ->check(one_of(names))
      ->type_name("NAME");
}

// For the help text.
std::string default_paper_folder() {
  const ProgramFiles& files = program_files();
  const std::string quick = "out/paper of " + files.output_parent;
  return files.installed ? quick : "docs, or with --sequences " + quick;
}

void add_paper_options(Command& command, EvaluateArguments& arguments) {
  CommandOption paper =
      command.add_flag("--paper", arguments.paper,
                       "all tables and figures of the paper, for every target with a model that ships");
  command
      .add_option("--mesh-folder", arguments.mesh_folder,
                  "folder with <target>.stl, y up: meshes to measure in addition to the shipped ones")
      ->check(file_path())
      ->type_name("DIR")
      ->needs(paper);
  command
      .add_option("--out", arguments.out,
                  "folder for results.md, .csv, .json and report.html [" + default_paper_folder() + "]")
      ->check(file_path())
      ->type_name("DIR")
      ->needs(paper);
}

}  // namespace

Subject set_up_subject(const ScenarioArguments& arguments) {
  TargetSetup setup = set_up_target(arguments);
  for (const std::string& warning : setup.warnings) print_note(warning);
  Subject subject;
  subject.target = arguments.target;
  subject.mesh_name = setup.mesh_name;
  subject.mesh = std::move(setup.mesh);
  subject.swath_m = 1e-3 * setup.projection.swath_mm;
  subject.model_name = std::filesystem::path(setup.model_path).stem().string();
  subject.model_crc32 = setup.header.crc32;
  subject.model = std::move(setup.model);
  subject.inertia_kg_m2 = setup.inertia_kg_m2;
  subject.sensor = arguments.sensor.sensor;
  subject.ranges = setup.ranges;
  subject.symmetry = arguments.symmetry;
  return subject;
}

void add_evaluate_options(Command& command, EvaluateArguments& arguments) {
  arguments.scenario.sequences = 900;
  add_target_options(command, arguments.scenario);
  add_condition_option(command, arguments.conditions);
  add_sequence_options(command, arguments.scenario, kMostInShards);
  add_model_options(command, arguments.scenario);
  add_run_options(command, arguments);
  add_results_options(command, arguments.files);
  add_shard_options(command, arguments);
  add_paper_options(command, arguments);
  add_sensor_options(command, arguments.scenario.sensor);
  add_effect_option(command, arguments.scenario.effects);
  add_effect_limit_option(command, arguments);
  add_symmetry_option(command, arguments.scenario.symmetry);
  add_disturbance_options(command, arguments.scenario.disturbances);
  command.footer("\nConditions\n" + condition_explanations() +
                 "\nThe error is the angle between true and estimated attitude in the last frame of\n"
                 "a sequence; ± is one standard error. Template matching, the classical method,\n"
                 "uses renderings of the same mesh as the frames. A frame counts as valid if the\n"
                 "attitude passes the checks of the flight program; wrong: more than 20° off.\n\n"
                 "Registered pose: attitude, position, rate and velocity after registration with\n"
                 "the surface mesh in the model image; shown where the image has one. Wrong: more\n"
                 "than 5° off. Inside 95 %: share of the verified poses within the 95 % ellipsoid\n"
                 "of their covariance.\n\n"
                 "The exit status is 4 if more than half of the attitudes in the last frame of a\n"
                 "condition are wrong. Not so with --paper, --effect-limit, and the effects that\n"
                 "show another body. 1: a file failed. 2: wrong arguments. 130 or 143 after Ctrl-C\n"
                 "or SIGTERM; then the figures so far are shown, if they are of one condition.\n\n"
                 "Example: two of the paper's tests, figures to a file, graphs to a page\n"
                 "  tumblesight evaluate --target near_shoemaker --condition nominal,occluded \\\n"
                 "      --json near.json --report near.html\n\n"
                 "Example: how much noise the network tolerates\n"
                 "  tumblesight evaluate --effect-limit noise --sequences 300 --json noise.json\n\n"
                 "Example: a tumbling spacecraft of your own, with a network trained for it\n"
                 "  tumblesight evaluate --target mine --mesh mine.glb --model mine.tsm \\\n"
                 "      --condition tumbling --inertia 410,380,300,0,-2,5\n\n"
                 "Example: everything in the paper, for all targets. For a quick look add\n"
                 "--sequences 20.\n"
                 "  tumblesight evaluate --paper --mesh-folder meshes\n" +
                 disturbance_examples("evaluate"));
}

ValueCheck shard_text() {
  return ValueCheck{[](std::string& text) {
                      try {
                        (void)shard_from(text);
                        return std::string();
                      } catch (const std::invalid_argument& error) {
                        return std::string(error.what());
                      }
                    },
                    "shard"};
}

void complete(const Command& command, EvaluateArguments& arguments) {
  take_period_of_sensor(command, arguments.scenario);
  if (!arguments.paper) require_a_name(command, {arguments.scenario.mesh});
  arguments.sequences_given = command.get_option("--sequences")->count() > 0;
  if (!arguments.shard.empty()) refuse_options_of_merge(command);
}

EvaluateArguments parsed_evaluate(const std::vector<std::string>& options) {
  CommandLine line;
  EvaluateArguments arguments;
  add_evaluate_options(line.command(), arguments);
  line.parse(options);
  complete(line.command(), arguments);
  return arguments;
}

void refuse_options_set_by_paper(const Command& command) {
  std::vector<std::string> own_options{
      "--target", "--mesh",   "--inertia", "--condition", "--frames", "--model", "--numerics", "--json",
      "--csv",    "--report", "--curves",  "--effect",    "--sensor", "--range", "--symmetry", "--shard"};
  for (const DisturbanceRow& row : kDisturbances) own_options.push_back(std::string("--") + row.name);
  for (const std::string& own : own_options) {
    if (command.get_option(own)->count() == 0) continue;
    throw ArgumentFault("--paper", "sets " + own + " itself; leave " + own + " out");
  }
}

void refuse_options_of_tables(const Command& command) {
  for (const char* other : {"--paper", "--curves", "--csv", "--report", "--baseline-sequences", "--shard"}) {
    if (command.get_option(other)->count() == 0) continue;
    throw ArgumentFault("--effect-limit", fmt::format("makes no tables; leave {} out", other));
  }
}

void refuse_options_of_merge(const Command& command) {
  for (const char* other : {"--json", "--csv", "--report"}) {
    if (command.get_option(other)->count() == 0) continue;
    throw ArgumentFault("--shard",
                        fmt::format("makes no figures; give {} to `tumblesight merge`, which does", other));
  }
}

namespace {

std::vector<Condition> conditions_of(const EvaluateArguments& arguments) {
  std::vector<Condition> conditions;
  for (const std::string& name : arguments.conditions) {
    const Condition condition = condition_from(name);
    const bool known = std::find(conditions.begin(), conditions.end(), condition) != conditions.end();
    if (known) throw ArgumentFault("--condition", fmt::format("'{}' is given twice", name));
    conditions.push_back(condition);
  }
  return conditions;
}

}  // namespace

ExperimentSettings experiment_settings(const EvaluateArguments& arguments) {
  ExperimentSettings settings;
  settings.seed = arguments.scenario.seed;
  settings.sequences = arguments.scenario.sequences;
  settings.tumbling_sequences = arguments.scenario.sequences;
  settings.frames = arguments.scenario.frames;
  settings.disturbances = arguments.scenario.disturbances;
  settings.effects = arguments.scenario.effects;
  settings.baseline_sequences = arguments.no_baseline ? 0 : arguments.baseline_sequences;
  settings.curves = arguments.curves;
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  settings.threads = arguments.threads > 0 ? arguments.threads : cores;
  return settings;
}

ExperimentSettings checked_settings(const EvaluateArguments& arguments) {
  ExperimentSettings settings = experiment_settings(arguments);
  settings.conditions = conditions_of(arguments);
  if (arguments.shard.empty())
    require_supported_length(arguments.scenario, "; divide it into parts with --shard");
  require_possible_disturbances(settings.disturbances, settings.frames);
  OptionFiles written = files_written(arguments.files);
  // A shard file is continued, and not replaced.
  written.push_back({"--shard-file", arguments.shard_file});
  require_separate_files(files_read(arguments.scenario), written);
  require_usable_files({}, files_written(arguments.files));
  return settings;
}

Subject checked_subject(const EvaluateArguments& arguments, const ExperimentSettings& settings) {
  Subject subject = set_up_subject(arguments.scenario);
  for (const Condition condition : settings.conditions) {
    (void)scenario_settings(condition, settings.frames, subject.target, subject.inertia_kg_m2);
  }
  return subject;
}

}  // namespace tumblesight::sim
