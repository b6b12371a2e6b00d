#include "sim/cli/campaign_actions.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>

#include "sim/campaign/campaign_results.hpp"
#include "sim/campaign/campaign_worker.hpp"
#include "sim/campaign/launcher.hpp"
#include "sim/cli/campaign_check.hpp"
#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/evaluation_output.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/end_with_starter.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/report/campaign_markdown.hpp"
#include "sim/report/results_files.hpp"
#include "sim/report/results_tables.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kLook{1};  // between two looks at the shard files
volatile std::sig_atomic_t told_to_stop = 0;

// Paths in the file are relative to its folder, so that is where we go.
OpenCampaign open_campaign(const CampaignArguments& arguments) {
  OpenCampaign open{read_campaign(arguments.file), {}, {}};
  const fs::path beside = fs::path(open.campaign.folder) / open.campaign.name;
  if (arguments.out.empty() && beside == open.campaign.file)
    throw std::invalid_argument(
        fmt::format("campaign '{}' has no extension .toml, so its results would take its name; give --out",
                    arguments.file));
  open.out = arguments.out.empty() ? beside.string() : full_path(arguments.out);
  open.tasks = tasks_of(open.campaign, open.out);
  fs::current_path(open.campaign.folder);
  return open;
}

void print_state(const OpenCampaign& open) {
  DataTable table{{"run", "sequences", "tasks", "done"}, {}};
  for (std::size_t i = 0; i < open.campaign.runs.size(); ++i) {
    std::uint64_t done = 0;
    std::size_t tasks = 0;
    for (const CampaignTask& task : open.tasks) {
      if (task.run != i) continue;
      ++tasks;
      done += sequences_done(task);
    }
    const CampaignRun& run = open.campaign.runs[i];
    table.rows.push_back({{run.name},
                          {std::to_string(run.sequences)},
                          {std::to_string(tasks)},
                          {fmt::format("{:.1f} %", 100.0 * static_cast<double>(done) / run.sequences)}});
  }
  fmt::print("\n{}\n  {} of {} in {}, folder {}\n\n", terminal_text(table), sequences_done(open.tasks),
             counted(open.sequences(), "sequence"), counted(open.tasks.size(), "task"), open.out);
  std::fflush(stdout);
}

void require_something_to_report(const CampaignArguments& arguments, const OpenCampaign& open) {
  const std::size_t left = tasks_left(open.tasks).size();
  if (left == 0 || arguments.partial) return;
  throw std::runtime_error(fmt::format(
      "campaign '{}': {} of {} are not done. `campaign run` goes on; --partial reports what there is",
      open.campaign.name, left, counted(open.tasks.size(), "task")));
}

// Names the campaign to which the folder belongs: a report of one must not replace that of another one.
std::string owner_path(const OpenCampaign& open) {
  return open.out + "/.campaign";
}

void require_own_folder(const OpenCampaign& open) {
  std::ifstream file(owner_path(open));
  std::string name;
  std::getline(file, name);
  if (name.empty() || name == open.campaign.name) return;
  throw std::runtime_error(
      fmt::format("folder '{}' is of the campaign '{}'; give another --out, or delete '{}' if this is the "
                  "same campaign under another name",
                  open.out, name, owner_path(open)));
}

// Returns the time of the file system, which may be on another machine.
fs::file_time_type claim_folder(const OpenCampaign& open) {
  write_file(owner_path(open), open.campaign.name + "\n");
  return fs::last_write_time(owner_path(open));
}

void report(const CampaignArguments& arguments, const OpenCampaign& open) {
  require_own_folder(open);
  require_same_options(open);
  require_something_to_report(arguments, open);
  ProgressBar bar("merging", "runs", open.campaign.runs.size());
  const MergeMode mode = arguments.partial ? MergeMode::kPartial : MergeMode::kComplete;
  Results results =
      campaign_results(open.campaign, open.tasks, mode, [&](std::size_t done) { bar.update(done); });
  bar.finish();
  if (results.subjects.empty())
    throw std::runtime_error(fmt::format("campaign '{}': no sequence is done yet", open.campaign.name));
  results.command = arguments.command_line;
  results.generated = local_time_text();
  (void)claim_folder(open);
  write_results_files(open.out, results, campaign_markdown(results));
  for (const std::string& note : results.notes) print_note(note);
  print_campaign(results);
  fmt::print("  report               {}\n\n", full_path(open.out + "/report.html"));
}

void make_log_folder(const OpenCampaign& open) {
  std::error_code error;
  fs::create_directories(open.out + "/logs", error);
  if (error)
    throw std::runtime_error(
        fmt::format("folder '{}/logs' cannot be made: {}; give another --out", open.out, error.message()));
}

std::unique_ptr<Launcher> launch(const CampaignArguments& arguments, const OpenCampaign& open) {
  LaunchSettings settings;
  settings.program = tool_path().string();
  settings.campaign = open.campaign;
  settings.out = open.out;
  settings.jobs = arguments.jobs;
  settings.options = shell_words(arguments.options);
  settings.tasks = open.tasks;
  settings.told_to_stop = [] { return told_to_stop != 0; };
  for (const LauncherRow& row : launcher_table())
    if (arguments.on == row.name) return row.launch(settings);
  throw std::logic_error("no such launcher");  // the option knows the names
}

// Until the work is done, or goes on no longer. The shard files tell how far it is.
void follow(const OpenCampaign& open, Launcher& launcher) {
  ProgressBar bar(open.campaign.name, "sequences", open.sequences(), stderr, sequences_done(open.tasks));
  bool running = true;
  while (running && told_to_stop == 0) {
    std::this_thread::sleep_for(kLook);
    running = launcher.running();
    try {
      bar.update(sequences_done(open.tasks));
    } catch (const std::runtime_error&) {
      // A file system that does not answer for a moment is no reason to end the workers.
    }
  }
  bar.finish();
}

// The launcher ends its workers when it goes out of scope, as it would not if a signal ended us.
void stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // nohup ignores SIGHUP.
    if (std::signal(signal, [](int) { told_to_stop = 1; }) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

// The "FAILED: ..." that a worker has written last, `since` then; empty: none. Logs of earlier calls stay.
std::string last_failure(const std::string& folder, fs::file_time_type since) {
  std::string last;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::error_code gone;
    const fs::file_time_type written = entry.last_write_time(gone);
    if (gone || written < since) continue;
    std::ifstream log(entry.path());
    for (std::string line; std::getline(log, line);) {
      const std::size_t at = line.find("FAILED: ");
      if (at == std::string::npos) continue;
      last = line.substr(at);
      since = written;
    }
  }
  return last;
}

std::string why_not_done(const OpenCampaign& open, const std::vector<std::size_t>& left,
                         const Launcher& launcher, const std::string& failure) {
  std::string why;
  if (!failure.empty()) why += failure + ". ";
  if (!launcher.fault().empty()) why += launcher.fault() + ". ";
  const bool elsewhere = std::any_of(left.begin(), left.end(),
                                     [&](std::size_t task) { return is_in_use(open.tasks[task].path); });
  if (elsewhere) why += "Other processes are running tasks of it: wait until they end, or end them. ";
  return why;
}

void require_all_done(const OpenCampaign& open, const Launcher& launcher, fs::file_time_type start) {
  const std::vector<std::size_t> left = tasks_left(open.tasks);
  if (left.empty()) return;
  const std::string logs = open.out + "/logs";
  throw std::runtime_error(
      fmt::format("campaign '{}': {} of {} are not done, the first: {}. {}Messages of the workers: {}. The "
                  "same command goes on where it stopped",
                  open.campaign.name, left.size(), counted(open.tasks.size(), "task"),
                  name_of(open.campaign, open.tasks[left.front()]),
                  why_not_done(open, left, launcher, last_failure(logs, start)), logs));
}

// What is done by its size may be damaged: that is removed, to be run again. Returns whether there was any.
bool cut_damaged_records(const OpenCampaign& open) {
  bool any = false;
  ProgressBar bar("verifying", "tasks", open.tasks.size());
  for (std::size_t i = 0; i < open.tasks.size() && told_to_stop == 0; ++i) {
    const std::uint64_t bytes = cut_to_whole_records(open.tasks[i].path);
    if (bytes > 0) print_note(dropped_text(open.tasks[i].path, bytes));
    any = any || bytes > 0;
    bar.update(i + 1);
  }
  bar.finish();
  return any;
}

// False: it was told to stop, or shall not wait.
bool run_tasks(const CampaignArguments& arguments, const OpenCampaign& open) {
  make_log_folder(open);
  const fs::file_time_type start = claim_folder(open);
  const std::unique_ptr<Launcher> launcher = launch(arguments, open);
  fmt::print("  started              {}\n", launcher->started());
  if (arguments.no_wait) return false;
  fmt::print("  Ctrl-C               {}\n\n",
             launcher->outlives_us() ? "ends only the progress bar; the jobs go on"
                                     : "stops the work; the same command goes on where it stopped");
  std::fflush(stdout);
  follow(open, *launcher);
  if (told_to_stop != 0) return false;
  // Jobs of an earlier call may be followed.
  require_all_done(open, *launcher, launcher->outlives_us() ? fs::file_time_type::min() : start);
  return true;
}

// Until everything is done and whole. False: it was told to stop, or shall not wait.
bool finish_tasks(const CampaignArguments& arguments, const OpenCampaign& open) {
  constexpr int kMostRounds = 3;
  for (int round = 0; round < kMostRounds; ++round) {
    if (!tasks_left(open.tasks).empty() && !run_tasks(arguments, open)) return false;
    if (!cut_damaged_records(open)) return told_to_stop == 0;
  }
  throw std::runtime_error(fmt::format(
      "campaign '{}': records are damaged again and again; check the disk, or the file system, of '{}'",
      open.campaign.name, open.out));
}

}  // namespace

void run_campaign(const CampaignArguments& arguments) {
  const OpenCampaign open = open_campaign(arguments);
  require_own_folder(open);
  check(open);
  print_state(open);
  if (arguments.dry_run) return;
  stop_on_signals();
  const bool is_done = finish_tasks(arguments, open);
  if (told_to_stop != 0) throw Exit(kStopped);
  if (is_done) report(arguments, open);
}

void work_on_campaign(const CampaignArguments& arguments) {
  if (arguments.supervised) end_with_starter();  // nothing of a worker is left when its starter is gone
  const OpenCampaign open = open_campaign(arguments);
  const std::optional<Shard> part =
      arguments.part.empty() ? std::nullopt : std::optional<Shard>(shard_from(arguments.part));
  const WorkerOutcome outcome = work(
      open.campaign, open.tasks, part,
      [&](const CampaignTask& task) { evaluate_shard(arguments_of(open, task)); },
      [](const std::string& text) {
        fmt::print("  {}\n", text);
        std::fflush(stdout);
      });
  fmt::print("  {}, {} failed\n", counted(outcome.done, "task") + " done", outcome.failures.size());
  // Whoever started us finds what is not done, and mpirun would end all other workers.
  const bool tell = !arguments.supervised || part;
  if (tell && !outcome.failures.empty()) throw Exit(kFailed);
}

void print_campaign(const CampaignArguments& arguments) {
  print_state(open_campaign(arguments));
}

void report_campaign(const CampaignArguments& arguments) {
  report(arguments, open_campaign(arguments));
}

}  // namespace tumblesight::sim
