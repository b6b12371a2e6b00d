#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sim/campaign/launcher.hpp"
#include "sim/process/child_process.hpp"
#include "sim/terminal/text.hpp"
#include "sim/terminal/write_file.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostParts = 1000;  // Slurm's usual MaxArraySize is 1001
constexpr double kMostOfACommand_s = 60.0;
constexpr int kMostSubmissions = 3;  // of the array, for parts of which a task died

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

// A job with the name of its cluster, where jobs go to several: "17", or "17;cluster".
std::string id_of(const std::string& job) {
  return job.substr(0, job.find(';'));
}

std::vector<std::string> with_cluster(const std::string& job, std::vector<std::string> arguments) {
  if (const std::size_t at = job.find(';'); at != std::string::npos)
    arguments.insert(arguments.begin(), {"-M", job.substr(at + 1)});
  return arguments;
}

struct Jobs {
  std::string array;
  std::string report;
};

// The jobs that a campaign has submitted last, in a file of its folder. It is locked meanwhile, so that of
// two calls of the program only one submits.
class JobsFile {
 public:
  explicit JobsFile(const std::string& path)
      : path_(path), file_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    if (file_ < 0 || flock(file_, LOCK_EX) != 0) {
      const std::string reason = std::strerror(errno);
      if (file_ >= 0) close(file_);
      throw std::runtime_error(fmt::format("the jobs file '{}' cannot be locked: {}", path, reason));
    }
  }
  ~JobsFile() { close(file_); }
  JobsFile(const JobsFile&) = delete;
  JobsFile& operator=(const JobsFile&) = delete;

  // No array: nothing was submitted.
  Jobs read() const {
    char bytes[256];
    const ssize_t size = pread(file_, bytes, sizeof bytes, 0);
    std::istringstream text(std::string(bytes, static_cast<std::size_t>(std::max<ssize_t>(0, size))));
    Jobs jobs;
    text >> jobs.array >> jobs.report;
    return jobs;
  }
  void write(const Jobs& jobs) const {
    const std::string text = jobs.array + " " + jobs.report + "\n";
    const auto size = static_cast<ssize_t>(text.size());
    if (ftruncate(file_, 0) == 0 && pwrite(file_, text.data(), text.size(), 0) == size) return;
    throw std::runtime_error(
        fmt::format("the jobs file '{}' cannot be written: {}", path_, std::strerror(errno)));
  }

 private:
  const std::string path_;
  const int file_;
};

class SlurmJobs final : public Launcher {
 public:
  explicit SlurmJobs(const LaunchSettings& settings) : settings_(settings) {
    fs::create_directories(settings.out + "/slurm");
    attach_or_submit();
    started_ = submissions_ > 0 ? fmt::format("Slurm job array {}, and job {} that makes the report after it",
                                              jobs_.array, jobs_.report)
                                : attached_text();
  }

  std::string started() const override { return started_; }
  bool outlives_us() const override { return true; }
  std::string fault() const override { return fault_; }
  bool running() override {
    if (is_queued(jobs_.array)) return true;
    const std::string left = parts_left(settings_);
    if (left.empty()) return is_queued(jobs_.report);
    fault_ =
        fmt::format("parts {} of the array are not done; their messages: {}", left, log_folder(settings_));
    if (submissions_ >= kMostSubmissions) return false;
    attach_or_submit();
    return true;
  }

 private:
  // An earlier call may have submitted the jobs and ended: Ctrl-C ends only the progress.
  void attach_or_submit() {
    const JobsFile file(settings_.out + "/slurm/jobs");
    const Jobs earlier = file.read();
    if (!earlier.array.empty() && is_queued(earlier.array)) {
      jobs_ = earlier;
      return;
    }
    ++submissions_;
    submit(file);
  }
  std::string attached_text() const {
    std::string all = jobs_.array;
    if (!jobs_.report.empty()) all += " and " + jobs_.report;
    return fmt::format(
        "nothing new: it follows the Slurm jobs {} of an earlier call, with the options of that call", all);
  }
  // "17", or "17;cluster" where jobs go to several clusters.
  std::string submitted(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"--parsable", "--job-name=" + settings_.campaign.name});
    arguments.insert(arguments.begin(), settings_.options.begin(), settings_.options.end());
    const std::string answer = output_of("sbatch", arguments, kMostOfACommand_s);
    return answer.substr(answer.rfind('\n') + 1);
  }
  void submit(const JobsFile& file) {
    const std::string script = settings_.out + "/slurm/part.sh";
    write_file(script, script_of(settings_));
    const std::string at_a_time = settings_.jobs > 0 ? fmt::format("%{}", settings_.jobs) : "";
    jobs_ = {submitted({"--array=" + parts_left(settings_) + at_a_time, "--requeue", "--open-mode=append",
                        "--output=" + log_folder(settings_) + "/slurm_%a.log", script}),
             ""};
    try {
      file.write(jobs_);
      jobs_.report = submitted(
          {"--dependency=afterany:" + id_of(jobs_.array),
           "--output=" + log_folder(settings_) + "/slurm_report.log", "--wrap",
           command_line(settings_, {"campaign", "report", settings_.campaign.file, "--out", settings_.out})});
      file.write(jobs_);
    } catch (const std::runtime_error& error) {
      // Nobody would know of the array.
      (void)output_of("scancel", with_cluster(jobs_.array, {id_of(jobs_.array)}), kMostOfACommand_s);
      throw std::runtime_error(fmt::format("{}. Job array {} was cancelled", error.what(), jobs_.array));
    }
  }
  // Slurm may have given the number to another job, after it has lost its state.
  bool is_queued(const std::string& job) const {
    const std::string id = id_of(job);
    if (id.empty()) return false;
    try {
      // A line per part, which begins with the job's number; -M adds a title.
      std::istringstream lines(
          output_of("squeue", with_cluster(job, {"-h", "-j", id, "-o", "%i %j"}), kMostOfACommand_s));
      for (std::string line; std::getline(lines, line);)
        if (line.rfind(id, 0) == 0 && line.substr(line.find(' ') + 1) == settings_.campaign.name) return true;
      return false;
    } catch (const std::runtime_error& error) {
      // Slurm forgets a job some minutes after its end. Any other failure may pass.
      return std::string(error.what()).find("Invalid job id") == std::string::npos;
    }
  }

  const LaunchSettings settings_;
  std::string started_;
  Jobs jobs_;
  int submissions_ = 0;  // by this call
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
