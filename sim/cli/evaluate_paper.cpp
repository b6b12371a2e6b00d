#include "sim/cli/evaluate_paper.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "sim/cli/subject_setup.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/model/model_file.hpp"
#include "sim/report/results_csv.hpp"
#include "sim/report/results_json.hpp"
#include "sim/report/results_markdown.hpp"
#include "sim/report/results_report.hpp"
#include "sim/report/results_table.hpp"
#include "sim/terminal/progress.hpp"
#include "sim/terminal/text_file.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// Empty when there is none.
std::string brought_mesh(const EvaluateArguments& arguments, const std::string& target) {
  if (arguments.mesh_folder.empty()) return {};
  const fs::path mesh = fs::path(arguments.mesh_folder) / (target + ".stl");
  return is_file(mesh) ? mesh.string() : std::string{};
}

std::string model_in(const std::string& folder, const std::string& name) {
  const fs::path model = fs::path(folder) / (name + ".tsm");
  const std::string remedy = remedy_for_missing_image(model.string());
  const bool is_recorded = is_file(fs::path(folder) / (name + ".json"));
  if (is_recorded && !is_file(model) && !remedy.empty()) {
    throw std::runtime_error(fmt::format("model image '{}' does not exist{}", model.string(), remedy));
  }
  return is_file(model) ? model.string() : std::string{};
}

// Nothing without a model; the curves on the first of the meshes.
std::vector<PlannedSubject> on_each_mesh(const EvaluateArguments& arguments, const std::string& target,
                                         const std::string& model, const std::string& mesh) {
  if (model.empty()) return {};
  PlannedSubject planned;
  planned.scenario = arguments.scenario;
  planned.scenario.target = target;
  planned.scenario.model = model;
  std::vector<PlannedSubject> all{planned};
  if (!mesh.empty()) {
    planned.scenario.mesh = mesh;
    all.insert(all.begin(), planned);
  }
  all.front().curves = true;
  return all;
}

struct Job {
  Subject subject;
  ExperimentSettings settings;
};

Job job_of(const EvaluateArguments& arguments, const PlannedSubject& planned) {
  Job job{set_up_subject(planned.scenario), experiment_settings(arguments)};
  job.settings.conditions = evaluated_conditions(planned.scenario.target);
  job.settings.curves = planned.curves;
  if (!planned.baseline) job.settings.baseline_sequences = 0;
  if (!arguments.sequences_given) job.settings.tumbling_sequences = kPaperTumblingSequences;
  return job;
}

// What anyone can run again: of the mesh folder the name only.
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
  return std::string(TUMBLESIGHT_SOURCE_DIR) + (arguments.sequences_given ? "/out/paper" : "/docs");
}

void write_results(const std::string& folder, const Results& results) {
  write_text_file(folder + "/results.md", results_markdown(results));
  write_text_file(folder + "/results.csv", results_csv(results));
  write_text_file(folder + "/results.json", results_json(results).dump(2) + "\n");
  write_text_file(folder + "/report.html", results_report(results));
}

void announce(const PaperPlan& plan, const EvaluateArguments& arguments, const std::string& folder) {
  fmt::print("\n  The paper's tables and figures, seed {}, into {}\n", arguments.scenario.seed,
             full_path(folder));
  for (const PlannedSubject& planned : plan.subjects) {
    fmt::print("    {}, {}, model {}{}\n", planned.scenario.target,
               planned.scenario.mesh.empty() ? std::string(kParametricMesh) + " mesh" : planned.scenario.mesh,
               fs::path(planned.scenario.model).filename().string(), planned.curves ? ", with curves" : "");
  }
  fmt::print("\n");
  std::fflush(stdout);
  for (const std::string& note : plan.notes) fmt::print(stderr, "  note: {}\n", note);
}

}  // namespace

PaperPlan plan_paper(const EvaluateArguments& arguments, const std::string& model_folder) {
  std::error_code error;
  if (!arguments.mesh_folder.empty() && !fs::is_directory(arguments.mesh_folder, error)) {
    throw std::runtime_error(fmt::format(
        "--mesh-folder '{}' is not a folder; give one that holds <target>.stl, y up", arguments.mesh_folder));
  }
  PaperPlan plan;
  std::vector<PlannedSubject> by_rule;
  for (const std::string& target : target_names()) {
    const std::string mesh = brought_mesh(arguments, target);
    const std::string model = model_in(model_folder, target);
    const std::string rule_model = model_in(model_folder, target + "_paper_rule");
    if (model.empty()) {
      plan.notes.push_back(fmt::format("{} is left out: no model {}.tsm ships yet.", target, target));
    } else if (mesh.empty() && !arguments.mesh_folder.empty()) {
      plan.notes.push_back(
          fmt::format("{}: no {}.stl in the mesh folder, parametric mesh only.", target, target));
    }
    for (const PlannedSubject& planned : on_each_mesh(arguments, target, model, mesh))
      plan.subjects.push_back(planned);
    for (PlannedSubject planned : on_each_mesh(arguments, target, rule_model, mesh)) {
      planned.curves = false;
      planned.baseline = model.empty();
      by_rule.push_back(planned);
    }
  }
  plan.subjects.insert(plan.subjects.end(), by_rule.begin(), by_rule.end());
  if (plan.subjects.empty()) {
    throw std::runtime_error(fmt::format(
        "no model image <target>.tsm in '{}': train one, see tumblesight train --help", model_folder));
  }
  return plan;
}

void evaluate_paper(const EvaluateArguments& arguments) {
  const std::string folder = folder_of(arguments);
  require_writable("--out", folder + "/results.md");
  const PaperPlan plan = plan_paper(arguments, fs::path(shipped_model_path("any")).parent_path().string());
  announce(plan, arguments, folder);
  // All meshes and models first: what is wrong with one comes up now, not after an hour.
  std::vector<Job> jobs;
  std::uint64_t steps = 0;
  for (const PlannedSubject& planned : plan.subjects) {
    jobs.push_back(job_of(arguments, planned));
    steps += steps_of(jobs.back().settings);
  }
  Results results{arguments.scenario.seed,
                  command_of(arguments),
                  fmt::format("{:%Y-%m-%d %H:%M %Z}", fmt::localtime(std::time(nullptr))),
                  plan.notes,
                  {}};
  ProgressBar bar("evaluating", "steps", steps);
  std::uint64_t done = 0;
  for (const Job& job : jobs) {
    results.subjects.push_back(run_experiment(
        job.subject, job.settings, [&](std::uint64_t steps_done) { bar.update(done + steps_done); }));
    done += steps_of(job.settings);
    write_results(folder, results);
  }
  bar.finish();
  fmt::print("\n{}\n  results              {}/results.md, .csv, .json and report.html\n\n",
             overview_table(results), full_path(folder));
}

}  // namespace tumblesight::sim
