#include "sim/cli/evaluate_arguments.hpp"

#include <algorithm>
#include <thread>

namespace tumblesight::sim {
namespace {

constexpr int kMostThreads = 1024;

void add_run_options(CLI::App& command, EvaluateArguments& arguments) {
  command.add_flag(
      "--curves", arguments.curves,
      "also rate drawn by its norm, hidden share and runs of 200 frames; takes seven times as long");
  CLI::Option* none = command.add_flag("--no-baseline", arguments.no_baseline, "leave template matching out");
  command
      .add_option("--baseline-sequences", arguments.baseline_sequences,
                  "sequences whose last frame template matching gets as well")
      ->check(whole_number(1, 100'000))
      ->type_name("N")
      ->capture_default_str()
      ->excludes(none);
  command
      .add_option("--threads", arguments.threads,
                  "worker threads; 0: one a core; the figures do not depend on it")
      ->check(whole_number(0, kMostThreads))
      ->type_name("N")
      ->capture_default_str();
}

void add_output_options(CLI::App& command, EvaluateArguments& arguments) {
  command
      .add_option("--csv", arguments.csv, "write the figures to this file, a line an estimator and condition")
      ->type_name("FILE");
  command
      .add_option("--report", arguments.report, "write an HTML page with all figures as graphs to this file")
      ->type_name("FILE");
}

void add_paper_options(CLI::App& command, EvaluateArguments& arguments) {
  CLI::Option* paper =
      command.add_flag("--paper", arguments.paper,
                       "all of the paper's tables and figures, for every target with a model in fsw/models");
  command
      .add_option("--mesh-folder", arguments.mesh_folder,
                  "folder with <target>.stl, y up: meshes to be measured beside the shipped ones")
      ->type_name("DIR")
      ->needs(paper);
  command
      .add_option("--out", arguments.out,
                  "folder for results.md, .csv, .json and report.html [docs; with --sequences out/paper]")
      ->type_name("DIR")
      ->needs(paper);
}

}  // namespace

void add_evaluate_options(CLI::App& command, EvaluateArguments& arguments) {
  arguments.scenario.sequences = 900;
  add_target_options(command, arguments.scenario);
  command.add_option("--condition", arguments.conditions, condition_help() + "; several: a,b")
      ->delimiter(',')
      ->check(one_of(condition_names()))
      ->type_name("NAMES")
      ->capture_default_str();
  add_sequence_options(command, arguments.scenario);
  add_file_options(command, arguments.scenario);
  add_run_options(command, arguments);
  add_output_options(command, arguments);
  add_paper_options(command, arguments);
  command.footer(
      "\nConditions\n" + condition_explanations() +
      "\nThe error is the angle between true and estimated attitude in the last frame of a sequence; ± is "
      "one\n"
      "standard error. Template matching, the classical way, sees renderings of the same mesh as the "
      "frames'.\n\n"
      "Example: two of the paper's tests, figures to a file, graphs to a page\n"
      "  tumblesight evaluate --target near_shoemaker --condition nominal,occluded --json near.json --report "
      "near.html\n\n"
      "Example: a spacecraft of your own that tumbles, with a network trained for it\n"
      "  tumblesight evaluate --target mine --mesh mine.glb --model mine.tsm --condition tumbling \\\n"
      "      --inertia 410,380,300,0,-2,5\n\n"
      "Example: everything in the paper, for all targets; renews docs/results.md (with\n"
      "--sequences, a quick look, it writes to out/paper of the source tree instead)\n"
      "  tumblesight evaluate --paper --mesh-folder meshes\n");
}

void require_paper_alone(const CLI::App& command) {
  for (const char* own : {"--target", "--mesh", "--inertia", "--condition", "--frames", "--model", "--json",
                          "--csv", "--report", "--curves"}) {
    if (command.get_option(own)->count() == 0) continue;
    throw CLI::ValidationError("--paper", std::string("decides on ") + own + " itself; leave that out");
  }
}

ExperimentSettings experiment_settings(const EvaluateArguments& arguments) {
  ExperimentSettings settings;
  settings.seed = arguments.scenario.seed;
  settings.sequences = arguments.scenario.sequences;
  settings.tumbling_sequences = arguments.scenario.sequences;
  settings.frames = arguments.scenario.frames;
  settings.baseline_sequences = arguments.no_baseline ? 0 : arguments.baseline_sequences;
  settings.curves = arguments.curves;
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  settings.threads = arguments.threads > 0 ? arguments.threads : cores;
  return settings;
}

}  // namespace tumblesight::sim
