#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "sim/campaign/launcher.hpp"
#include "sim/host/child_process.hpp"
#include "sim/host/end_with_starter.hpp"
#include "sim/host/place.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostParts = 1000;  // Slurm's usual MaxArraySize is 1001
constexpr double kMostOfAQuestion_s = 60.0, kMostOfASubmission_s = 180.0;
constexpr std::chrono::minutes kMostWithoutAnAnswer{10};
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
      "{}=$$ {} --part \"$SLURM_ARRAY_TASK_ID/{}\" && exit 0\n"
      "status=$?\n"
      "if [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt 2 ]; then\n"
      "  scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\"\n"
      "fi\n"
      "exit $status\n",
      kStarterVariable, command_line(settings, worker_arguments(settings)), parts_of(settings));
}

// The parts with a task that is not done: "0,3,7".
std::string parts_left(const LaunchSettings& settings) {
  std::set<std::size_t> parts;
  for (const std::size_t task : tasks_left(settings.tasks)) parts.insert(task % parts_of(settings));
  std::string text;
  for (const std::size_t part : parts) text += (text.empty() ? "" : ",") + std::to_string(part);
  return text;
}

// "17", or "17;cluster".
bool is_job(const std::string& text) {
  const std::string id = text.substr(0, text.find(';'));
  return !id.empty() && id.find_first_not_of("0123456789") == std::string::npos;
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

  std::string text() const { return report.empty() ? array : array + " and " + report; }
  // What cancels them, as the user types it.
  std::string cancel_command() const {
    std::string line = "scancel";
    for (const std::string& word : with_cluster(array, {id_of(array)})) line += " " + word;
    return report.empty() ? line : line + " " + id_of(report);
  }
};

// The jobs that a campaign has submitted last, in a file of its folder. It is locked meanwhile, so that of
// two calls of the program only one submits.
class JobsFile {
 public:
  explicit JobsFile(const std::string& path) : path_(path), file_(open_to_write(path, O_RDWR)) {}
  ~JobsFile() { close(file_); }
  JobsFile(const JobsFile&) = delete;
  JobsFile& operator=(const JobsFile&) = delete;

  // Waits for another call of the program. False: told to stop.
  bool lock(const std::function<bool()>& told_to_stop) const {
    for (bool is_waiting = false; !told_to_stop(); is_waiting = true) {
      if (flock(file_, LOCK_EX | LOCK_NB) == 0) return true;
      if (errno != EWOULDBLOCK && errno != EINTR)
        throw std::runtime_error(
            fmt::format("the jobs file '{}' cannot be locked: {}; give an --out on a file system with locks",
                        path_, std::strerror(errno)));
      if (!is_waiting) print_note("waiting for another call that submits these jobs");
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
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
    if (submissions_ > 0)
      started_ = fmt::format("Slurm job array {}, and job {} that makes the report after it", jobs_.array,
                             jobs_.report);
    else if (jobs_.array.empty())
      started_ = "nothing";
    else
      started_ = fmt::format(
          "nothing new: the Slurm jobs {} of an earlier call go on, with the options of that call. To submit "
          "others: {}, and then the same command",
          jobs_.text(), jobs_.cancel_command());
  }

  std::string started() const override { return started_; }
  bool outlives_us() const override { return true; }
  std::string fault() const override { return fault_; }
  bool running() override {
    const State array = state_of(jobs_.array);
    const std::string left = parts_left(settings_);
    const State state = array == State::kGone && left.empty() ? state_of(jobs_.report) : array;
    if (state == State::kUnknown) return may_answer_later();
    last_answer_ = Clock::now();
    if (state == State::kQueued) return true;
    if (left.empty()) return false;
    fault_ =
        fmt::format("parts {} of the array are not done; their messages: {}", left, log_folder(settings_));
    if (submissions_ >= kMostSubmissions) return false;
    attach_or_submit();
    return true;
  }

 private:
  // An earlier call may have submitted the jobs and ended: Ctrl-C ends only the progress.
  void attach_or_submit() {
    const std::string path = settings_.out + "/slurm/jobs";
    const JobsFile file(path);
    if (!file.lock(settings_.told_to_stop)) return;
    const Jobs earlier = file.read();
    const State state = state_of(earlier.array);
    if (state == State::kUnknown)
      throw std::runtime_error(
          fmt::format("whether the Slurm jobs {} of an earlier call go on is not known: {}. Try again later, "
                      "or delete '{}' to submit new ones",
                      earlier.text(), no_answer_, path));
    if (state == State::kQueued) {
      jobs_ = earlier;
      return;
    }
    ++submissions_;
    submit(file);
  }
  // "17", or "17;cluster" where jobs go to several clusters.
  std::string submitted(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"--parsable", "--job-name=" + settings_.campaign.name});
    arguments.insert(arguments.begin(), settings_.options.begin(), settings_.options.end());
    try {
      const std::string answer = output_of("sbatch", arguments, kMostOfASubmission_s);
      const std::string job = answer.substr(answer.rfind('\n') + 1);
      if (!is_job(job))
        throw std::runtime_error(fmt::format("sbatch has answered '{}' in place of a job's number. {}",
                                             shortened(job), may_be_taken()));
      return job;
    } catch (const std::runtime_error& error) {
      if (std::string(error.what()).find("takes longer") == std::string::npos) throw;
      throw std::runtime_error(fmt::format("{}. {}", error.what(), may_be_taken()));
    }
  }
  std::string may_be_taken() const {
    return fmt::format("Slurm may have taken the job: end what `squeue --name={}` shows before the next try",
                       settings_.campaign.name);
  }
  // What has become of the array after a failure.
  std::string end_array() const {
    try {
      (void)output_of("scancel", with_cluster(jobs_.array, {id_of(jobs_.array)}), kMostOfAQuestion_s);
      return fmt::format("Job array {} was cancelled", jobs_.array);
    } catch (const std::runtime_error& error) {
      return fmt::format("Job array {} goes on, since {}; to end it: {}", jobs_.array, error.what(),
                         Jobs{jobs_.array, ""}.cancel_command());
    }
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
      throw std::runtime_error(fmt::format("{}. {}", error.what(), end_array()));
    }
  }
  // A failure of squeue may pass, but not every one does.
  bool may_answer_later() {
    if (Clock::now() - last_answer_ < kMostWithoutAnAnswer) return true;
    fault_ = fmt::format("for {} minutes the state of the Slurm jobs {} was not known: {}",
                         kMostWithoutAnAnswer.count(), jobs_.text(), no_answer_);
    return false;
  }
  // Queued or running; no job of ours; squeue does not tell. Slurm may have given the number to another job,
  // after it has lost its state.
  enum class State { kQueued, kGone, kUnknown };
  State state_of(const std::string& job) {
    const std::string id = id_of(job);
    if (id.empty()) return State::kGone;
    try {
      // A line per part, which begins with the job's number; -M adds a title.
      std::istringstream lines(
          output_of("squeue", with_cluster(job, {"-h", "-j", id, "-o", "%i %j"}), kMostOfAQuestion_s));
      for (std::string line; std::getline(lines, line);)
        if (line.rfind(id, 0) == 0 && line.substr(line.find(' ') + 1) == settings_.campaign.name)
          return State::kQueued;
      return State::kGone;
    } catch (const std::runtime_error& error) {
      no_answer_ = error.what();
      // Slurm forgets a job some minutes after its end.
      return no_answer_.find("Invalid job id") == std::string::npos ? State::kUnknown : State::kGone;
    }
  }

  const LaunchSettings settings_;
  std::string started_;
  Jobs jobs_;
  int submissions_ = 0;    // by this call
  std::string no_answer_;  // the last failure of squeue
  Clock::time_point last_answer_ = Clock::now();
  std::string fault_;
};

}  // namespace

std::unique_ptr<Launcher> launch_slurm(const LaunchSettings& settings) {
  try {
    (void)output_of("sbatch", {"--version"}, kMostOfAQuestion_s);
  } catch (const ProgramFailure& error) {
    throw std::runtime_error(fmt::format(
        "{}; the machine must be one from which jobs can be submitted (Debian: slurm-client)", error.what()));
  }
  return std::make_unique<SlurmJobs>(settings);
}

}  // namespace tumblesight::sim
