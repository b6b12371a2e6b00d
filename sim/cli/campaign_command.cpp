#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "sim/campaign/launcher.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/campaign_actions.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/verbs.hpp"

namespace tumblesight::sim {
namespace {

void add_file(Command& command, CampaignArguments& arguments) {
  command.add_option("file", arguments.file, "the campaign, a TOML file")
      ->required()
      ->check(existing_file())
      ->type_name("FILE");
  command
      .add_option("--out", arguments.out,
                  "folder of shard files, logs and report [the file's path without .toml]")
      ->check(file_path())
      ->type_name("DIR");
}

std::string explanations_of_launchers() {
  std::string text;
  for (const LauncherRow& row : launcher_table())
    text += fmt::format("  {:<7} {}\n", row.name, row.explanation);
  return text;
}

std::vector<std::string> launcher_names() {
  std::vector<std::string> names;
  for (const LauncherRow& row : launcher_table()) names.emplace_back(row.name);
  return names;
}

void add_run(Command& verb, const std::shared_ptr<CampaignArguments>& arguments) {
  Command command =
      verb.add_subcommand("run", "Run what is not done yet, with progress, and make the report");
  add_file(command, *arguments);
  command.add_option("--on", arguments->on, "how the workers are started")
      ->check(one_of(launcher_names()))
      ->type_name("WAY")
      ->capture_default_str();
  limit_whole_number(command.add_option("--jobs", arguments->jobs,
                                        "workers at a time, 0: one per core, or as many as Slurm starts"),
                     0, 100'000)
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--options", arguments->options,
                  "further options of sbatch or mpirun, one text: \"--partition=long --time=2:00:00\"")
      ->type_name("TEXT");
  command.add_flag("--no-wait", arguments->no_wait, "end when the Slurm jobs are submitted");
  command.add_flag("--dry-run", arguments->dry_run, "only check the file and show the runs");
  command.footer("\nWays to start workers\n" + explanations_of_launchers());
  command.callback([arguments] {
    if (arguments->no_wait && arguments->on != "slurm")
      throw ArgumentFault("--no-wait", "is for --on slurm; other workers end with this program");
    if (!arguments->options.empty() && arguments->on == "local")
      throw ArgumentFault("--options", "are those of sbatch or mpirun; give --on slurm or --on mpi");
    run_campaign(*arguments);
  });
}

void add_work(Command& verb, const std::shared_ptr<CampaignArguments>& arguments) {
  Command command =
      verb.add_subcommand("work", "Be one worker: run tasks until none is left. `run` starts workers");
  add_file(command, *arguments);
  command
      .add_option("--part", arguments->part,
                  "only the tasks of part I of N, I from 0; otherwise the next one that nobody runs")
      ->check(shard_text())
      ->type_name("I/N");
  command.add_flag("--supervised", arguments->supervised,
                   "end with the program that started it; the exit status is 0 if tasks failed");
  command.callback([arguments] { work_on_campaign(*arguments); });
}

void add_status(Command& verb, const std::shared_ptr<CampaignArguments>& arguments) {
  Command command = verb.add_subcommand("status", "Show how far each run is");
  add_file(command, *arguments);
  command.callback([arguments] { print_campaign(*arguments); });
}

void add_report(Command& verb, const std::shared_ptr<CampaignArguments>& arguments) {
  Command command =
      verb.add_subcommand("report", "Make tables, JSON, CSV and report.html of the shard files");
  add_file(command, *arguments);
  command.add_flag("--partial", arguments->partial,
                   "make the figures from the sequences that are done, although some are missing");
  command.callback([arguments] { report_campaign(*arguments); });
}

}  // namespace

void add_campaign_command(Command& app, const std::string& command_line) {
  Command command = add_verb(app, "campaign");
  command.require_subcommand(1);
  auto arguments = std::make_shared<CampaignArguments>();
  arguments->command_line = command_line;
  add_run(command, arguments);
  add_work(command, arguments);
  add_status(command, arguments);
  add_report(command, arguments);
  command.footer(
      "\nA campaign is a TOML file. A [[run]] has options of `tumblesight evaluate`\n"
      "without their dashes; a list makes a run for each of its values. Paths are\n"
      "relative to the folder of the file.\n\n"
      "  seed = 22\n"
      "  sequences_per_task = 5000   # of a shard; a task should take some minutes\n\n"
      "  [[run]]\n"
      "  target = \"near_shoemaker\"\n"
      "  condition = [\"nominal\", \"degraded\"]\n"
      "  sequences = 400000\n\n"
      "  [[run]]\n"
      "  target = \"near_shoemaker\"\n"
      "  effect = [\"noise=5\", \"background=0.5\", \"rays=32,noise=2\"]\n"
      "  sequences = 15000\n\n"
      "The work can be stopped at any time; the same command goes on. The report has\n"
      "bounds of all rates, and the worst sequences with the command that shows each.\n\n"
      "The exit status of `run` is 0 if all is done and reported, or submitted with\n"
      "--no-wait; 1 if something failed, 2 for wrong arguments, 3 if it was stopped.\n\n"
      "Example\n"
      "  tumblesight campaign run near.toml\n"
      "  tumblesight campaign run near.toml --on slurm --options \"--partition=long\"\n"
      "  tumblesight campaign report near.toml --partial\n\n"
      "Clusters, costs and limits: docs/cluster.md\n");
}

}  // namespace tumblesight::sim
