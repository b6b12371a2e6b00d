#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/interruptible_experiment.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/experiment/paper_plan.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/report/results_files.hpp"
#include "sim/report/results_tables.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

struct Job {
  Subject subject;
  ExperimentSettings settings;
};

Job job_of(const EvaluateArguments& arguments, const PlannedSubject& planned) {
  ScenarioArguments scenario = arguments.scenario;
  scenario.target = planned.target;
  scenario.model = planned.model;
  scenario.mesh = planned.mesh;
  Job job{set_up_subject(scenario), experiment_settings(arguments)};
  job.settings.conditions = evaluated_conditions(planned.target);
  job.settings.curves = planned.curves;
  job.settings.disturbed_runs = planned.disturbed_runs;
  job.settings.sensor_runs = planned.sensor_runs;
  if (!planned.baseline) job.settings.baseline_sequences = 0;
  if (!arguments.sequences_given) job.settings.tumbling_sequences = kPaperTumblingSequences;
  return job;
}

// For the document: only the name of the mesh folder, not its path on this machine.
std::string command_of(const EvaluateArguments& arguments) {
  std::string command = "tumblesight evaluate --paper";
  if (arguments.sequences_given) command += fmt::format(" --sequences {}", arguments.scenario.sequences);
  command += fmt::format(" --seed {}", arguments.scenario.seed);
  if (arguments.no_baseline) command += " --no-baseline";
  if (!arguments.no_baseline)
    command += fmt::format(" --baseline-sequences {}", arguments.baseline_sequences);
  if (!arguments.mesh_folder.empty()) {
    command += " --mesh-folder " + fs::path(full_path(arguments.mesh_folder)).filename().string();
  }
  return command;
}

std::string folder_of(const EvaluateArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  const ProgramFiles& files = program_files();
  return arguments.sequences_given || files.installed ? files.output + "/paper" : files.root + "/docs";
}

void announce(const PaperPlan& plan, const EvaluateArguments& arguments, const std::string& folder) {
  fmt::print("\n  The paper's tables and figures, seed {}, into {}\n", arguments.scenario.seed,
             full_path(folder));
  for (const PlannedSubject& planned : plan.subjects) {
    fmt::print("    {}, {}, model {}{}\n", planned.target,
               planned.mesh.empty() ? std::string(kParametricMesh) + " mesh" : planned.mesh,
               fs::path(planned.model).filename().string(), planned.curves ? ", with curves" : "");
  }
  fmt::print("\n");
  std::fflush(stdout);
  for (const std::string& note : plan.notes) print_note(note);
}

[[noreturn]] void report_interruption(std::size_t finished, std::size_t all, const std::string& folder) {
  const std::string kept =
      finished == 0
          ? "no file was written"
          : fmt::format("results.md, .csv, .json and report.html in {} hold those", full_path(folder));
  print_message(
      fmt::format("tumblesight: interrupted by signal {} after {} of the {}; {}, and the same command begins "
                  "anew. A campaign can be continued: see tumblesight campaign --help",
                  Interruption::signal(), finished, counted(all, "subject"), kept));
  throw Exit(128 + Interruption::signal());
}

}  // namespace

void evaluate_paper(const EvaluateArguments& arguments) {
  const std::string folder = folder_of(arguments);
  const PaperPlan plan = plan_paper(arguments.mesh_folder, program_files().models);
  announce(plan, arguments, folder);
  // All meshes and models first, so that a fault in one of them shows now and not after an hour.
  std::vector<Job> jobs;
  std::uint64_t steps = 0;
  for (const PlannedSubject& planned : plan.subjects) {
    jobs.push_back(job_of(arguments, planned));
    steps += steps_of(jobs.back().settings);
  }
  OptionFiles read, written;
  for (const PlannedSubject& planned : plan.subjects) {
    for (const OptionFile& file : mesh_files_read("--mesh-folder", planned.mesh)) read.push_back(file);
    read.push_back({"the models", planned.model});
  }
  for (const char* name : {"/results.md", "/results.csv", "/results.json", "/report.html"})
    written.push_back({"--out", folder + name});
  require_usable_files(read, written);
  Results results{arguments.scenario.seed, command_of(arguments), local_time_text(), plan.notes, {}};
  ProgressBar bar("evaluating", "steps", steps);
  std::uint64_t done = 0;
  const Interruption interruption;
  for (const Job& job : jobs) {
    ExperimentFigures figures(job.subject, job.settings);
    std::size_t sequences = 0;
    try {
      run_until_signal(job.subject, job.settings, figures, sequences,
                       [&](std::uint64_t steps_done) { bar.update(done + steps_done); });
    } catch (const Interrupted&) {
      bar.finish();
      report_interruption(results.subjects.size(), jobs.size(), folder);
    }
    results.subjects.push_back(figures.finish());
    done += steps_of(job.settings);
    write_results_files(folder, results, results_markdown(results));
  }
  bar.finish();
  fmt::print("\n{}\n  results              {}/results.md, .csv, .json and report.html\n\n",
             terminal_text(conditions_table(results.subjects, kTerminalOverview)), full_path(folder));
}

}  // namespace tumblesight::sim
