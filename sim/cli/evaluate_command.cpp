#include <fmt/format.h>

#include <memory>
#include <vector>

#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/evaluation_output.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/interruptible_experiment.hpp"
#include "sim/cli/mesh_advice.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {
namespace {

// With the figures so far if they are of one condition: those of several are of unlike numbers of sequences.
// No file is written.
[[noreturn]] void report_interruption(const EvaluateArguments& arguments, const ExperimentSettings& settings,
                                      ExperimentFigures& figures, Results& results, std::size_t sequences) {
  const std::size_t wanted = sequences_of(settings);
  const int signal = Interruption::signal();
  if (runs_of(settings).size() == 1) {
    fmt::print("\n  The figures so far, of {} of the {}:\n", sequences, counted(wanted, "sequence"));
    results.subjects.push_back(figures.finish());
    set_replay(results.subjects.back(), arguments.command_line);
    print_results(results);
  }
  print_message(
      fmt::format("tumblesight: interrupted by signal {} after {} of the {}; no file was written, and the "
                  "same command begins "
                  "anew. One with --shard and --shard-file can be continued: see tumblesight evaluate --help",
                  signal, sequences, counted(wanted, "sequence")));
  throw Exit(128 + signal);
}

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
  const Subject subject = checked_subject(arguments, settings);
  announce(subject, settings);

  Results results;
  results.seed = settings.seed;
  results.command = arguments.command_line;
  results.generated = local_time_text();
  ProgressBar bar("evaluating", "steps", steps_of(settings));
  ExperimentFigures figures(subject, settings);
  std::size_t sequences = 0;
  const Interruption interruption;
  try {
    run_until_signal(subject, settings, figures, sequences, [&](std::uint64_t done) { bar.update(done); });
  } catch (const Interrupted&) {
    bar.finish();
    report_interruption(arguments, settings, figures, results, sequences);
  }
  results.subjects.push_back(figures.finish());
  bar.finish();
  set_replay(results.subjects.back(), arguments.command_line);
  write_files(arguments.files, results);  // first: what is printed may have no reader any more
  print_results(results);
  const bool wrong = print_what_is_wrong(arguments, subject, results.subjects.front());
  print_report_path(arguments.files);
  if (wrong) throw Exit(kOfNoUse);
}

}  // namespace

void add_evaluate_command(Command& app, const std::string& command_line) {
  Command command = add_verb(app, "evaluate");
  auto arguments = std::make_shared<EvaluateArguments>();
  arguments->command_line = command_line;
  add_evaluate_options(command, *arguments);
  command.callback([arguments, command] {
    complete(command, *arguments);
    if (!arguments->effect_limit.empty()) {
      refuse_options_of_tables(command);
      evaluate_effect_limit(*arguments);
    } else if (arguments->paper) {
      refuse_options_set_by_paper(command);
      evaluate_paper(*arguments);
    } else if (!arguments->shard.empty()) {
      evaluate_shard(*arguments);
    } else {
      evaluate(*arguments);
    }
  });
}

}  // namespace tumblesight::sim
