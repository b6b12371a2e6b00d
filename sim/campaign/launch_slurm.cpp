#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sim/campaign/launcher.hpp"
#include "sim/process/child_process.hpp"
#include "sim/terminal/text.hpp"
#include "sim/terminal/write_file.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostParts = 1000;  // Slurm's usual MaxArraySize is 1001
constexpr double kMostOfACommand_s = 60.0;
constexpr int kMostRounds = 3;  // of the array, for parts of which a task died

std::string command_line(const LaunchSettings& settings, const std::vector<std::string>& arguments) {
  std::string line = shell_word(settings.program);
  for (const std::string& argument : arguments) line += " " + shell_word(argument);
  return line;
}

std::size_t parts_of(const LaunchSettings& settings) {
  return std::min(settings.tasks.size(), kMostParts);
}

// A task that is killed leaves the shell, which asks for another try. Slurm itself does so when a node fails.
std::string script_of(const LaunchSettings& settings) {
  return fmt::format(
      "#!/bin/sh\n"
      "# One part of the tasks of a campaign, for a Slurm job array. Made by `tumblesight campaign run`.\n"
      "{} --part \"$SLURM_ARRAY_TASK_ID/{}\" && exit 0\n"
      "status=$?\n"
      "if [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt 2 ]; then\n"
      "  scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\"\n"
      "fi\n"
      "exit $status\n",
      command_line(settings, worker_arguments(settings)), parts_of(settings));
}

// The parts with a task that is not done: "0,3,7".
std::string parts_left(const LaunchSettings& settings) {
  std::set<std::size_t> parts;
  for (const std::size_t task : tasks_left(settings.tasks)) parts.insert(task % parts_of(settings));
  std::string text;
  for (const std::size_t part : parts) text += (text.empty() ? "" : ",") + std::to_string(part);
  return text;
}

class SlurmJobs final : public Launcher {
 public:
  explicit SlurmJobs(const LaunchSettings& settings) : settings_(settings) {
    script_ = settings.out + "/slurm/part.sh";
    write_file(script_, script_of(settings));
    submit();
  }

  std::string started() const override {
    return fmt::format("Slurm job array {}, and job {} that makes the report after it", array_, report_);
  }
  bool outlives_us() const override { return true; }
  std::string fault() const override { return fault_; }
  bool running() override {
    if (is_queued(array_)) return true;
    const std::string left = parts_left(settings_);
    if (left.empty()) return is_queued(report_);
    fault_ =
        fmt::format("parts {} of the array are not done; their messages: {}", left, log_folder(settings_));
    if (++rounds_ >= kMostRounds) return false;
    submit();
    return true;
  }

 private:
  // "17", or "17;cluster" where jobs go to several clusters.
  std::string submitted(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"--parsable", "--job-name=" + settings_.campaign.name});
    arguments.insert(arguments.begin(), settings_.options.begin(), settings_.options.end());
    const std::string answer = output_of("sbatch", arguments, kMostOfACommand_s);
    return answer.substr(answer.rfind('\n') + 1);
  }
  void submit() {
    const std::string at_a_time = settings_.jobs > 0 ? fmt::format("%{}", settings_.jobs) : "";
    array_ = submitted({"--array=" + parts_left(settings_) + at_a_time, "--requeue", "--open-mode=append",
                        "--output=" + log_folder(settings_) + "/slurm_%a.log", script_});
    try {
      report_ = submitted(
          {"--dependency=afterany:" + id_of(array_),
           "--output=" + log_folder(settings_) + "/slurm_report.log", "--wrap",
           command_line(settings_, {"campaign", "report", settings_.campaign.file, "--out", settings_.out})});
    } catch (const std::runtime_error& error) {
      // Nobody would know of the array.
      (void)output_of("scancel", with_cluster(array_, {id_of(array_)}), kMostOfACommand_s);
      throw std::runtime_error(fmt::format("{}. Job array {} was cancelled", error.what(), array_));
    }
  }
  static std::string id_of(const std::string& job) { return job.substr(0, job.find(';')); }
  static std::vector<std::string> with_cluster(const std::string& job, std::vector<std::string> arguments) {
    if (const std::size_t at = job.find(';'); at != std::string::npos)
      arguments.insert(arguments.begin(), {"-M", job.substr(at + 1)});
    return arguments;
  }
  static bool is_queued(const std::string& job) {
    const std::string id = id_of(job);
    try {
      // A line per part, which begins with the job's number; -M adds a title.
      std::istringstream lines(
          output_of("squeue", with_cluster(job, {"-h", "-j", id, "-o", "%i"}), kMostOfACommand_s));
      for (std::string line; std::getline(lines, line);)
        if (line.rfind(id, 0) == 0) return true;
      return false;
    } catch (const std::runtime_error& error) {
      // Slurm forgets a job some minutes after its end. Any other failure may pass.
      return std::string(error.what()).find("Invalid job id") == std::string::npos;
    }
  }

  const LaunchSettings settings_;
  std::string script_;
  std::string array_;
  std::string report_;
  int rounds_ = 0;
  std::string fault_;
};

}  // namespace

std::unique_ptr<Launcher> launch_slurm(const LaunchSettings& settings) {
  try {
    (void)output_of("sbatch", {"--version"}, kMostOfACommand_s);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format(
        "{}; the machine must be one from which jobs can be submitted (Debian: slurm-client)", error.what()));
  }
  return std::make_unique<SlurmJobs>(settings);
}

}  // namespace tumblesight::sim
