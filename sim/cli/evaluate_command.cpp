#include <fmt/format.h>

#include <memory>

#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/evaluation_output.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/terminal/progress.hpp"
#include "sim/terminal/text.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

// Returns whether there is a condition with mostly wrong attitudes. Says what each has, and what it can mean.
bool print_what_is_wrong(const EvaluateArguments& arguments, const Subject& subject,
                         const SubjectResult& result) {
  const CellResult* first = print_mostly_wrong(result);
  if (first == nullptr) return false;
  const Swaths swaths{swath_m(subject.mesh), subject.swath_m};
  fmt::print("{}", mesh_advice(arguments.scenario, swaths, first->rcnn, first->common_turn));
  return true;
}

void evaluate(const EvaluateArguments& arguments) {
  const ExperimentSettings settings = checked_settings(arguments);
  const std::vector<std::string> left_out =
      settings.peers ? missing_peers(pose_peers()) : std::vector<std::string>{};
  const Subject subject = checked_subject(arguments, settings);
  announce(subject, settings);
  for (const std::string& line : left_out) print_note("left out: " + line);

  Results results;
  results.seed = settings.seed;
  results.command = arguments.command_line;
  results.generated = local_time_text();
  ProgressBar bar("evaluating", "steps", steps_of(settings));
  results.subjects.push_back(
      run_experiment(subject, settings, [&](std::uint64_t done) { bar.update(done); }));
  bar.finish();
  set_replay(results.subjects.back(), arguments.command_line);
  write_files(arguments.files, results);  // first: what is printed may have no reader any more
  print_results(results);
  const bool wrong = print_what_is_wrong(arguments, subject, results.subjects.front());
  print_report_path(arguments.files);
  if (wrong) throw CLI::RuntimeError(kOfNoUse);
}

}  // namespace

void add_evaluate_command(CLI::App& app, const std::string& command_line) {
  CLI::App* command = app.add_subcommand(
      "evaluate", "Measure the accuracy of a model over many sequences, without the flight program");
  auto arguments = std::make_shared<EvaluateArguments>();
  arguments->command_line = command_line;
  add_evaluate_options(*command, *arguments);
  command->callback([arguments, command] {
    complete(*command, *arguments);
    if (!arguments->effect_limit.empty()) {
      refuse_options_of_tables(*command);
      evaluate_effect_limit(*arguments);
    } else if (arguments->paper) {
      refuse_options_set_by_paper(*command);
      evaluate_paper(*arguments);
    } else if (!arguments->shard.empty()) {
      evaluate_shard(*arguments);
    } else {
      evaluate(*arguments);
    }
  });
}

}  // namespace tumblesight::sim
