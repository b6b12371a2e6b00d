#include "sim/host/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "sim/host/place.hpp"

extern char** environ;

namespace tumblesight::sim {
namespace {

constexpr double kGrace_s = 2.0;

// Opened here: a failure of posix_spawn() does not tell the program from its files.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path) {
    if (path.empty()) return;
    file_ = open_emptied(path, Place(path));
  }
  ~OutputFile() {
    if (file_ >= 0) close(file_);
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  int file() const { return file_; }  // -1: none

 private:
  int file_ = -1;
};

class SpawnActions {
 public:
  SpawnActions(const OutputFile& log, const OutputFile& output, int inherited_file) {
    posix_spawn_file_actions_init(&actions_);
    // dup2 onto itself clears the close-on-exec flag.
    if (inherited_file >= 0) posix_spawn_file_actions_adddup2(&actions_, inherited_file, inherited_file);
    if (log.file() < 0) return;
    posix_spawn_file_actions_adddup2(&actions_, log.file(), STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, output.file() < 0 ? log.file() : output.file(),
                                     STDOUT_FILENO);
  }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

class SpawnAttributes {
 public:
  explicit SpawnAttributes(ProcessGroup group) {
    posix_spawnattr_init(&attributes_);
    if (group == ProcessGroup::kOurs) return;
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

std::string temporary_folder() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (!error) return folder.string();
  const char* const named = std::getenv("TMPDIR");
  throw std::runtime_error(
      "the folder for temporary files, '" + std::string(named != nullptr ? named : "/tmp") +
      "', is not there: " + error.message() + "; make it, or set TMPDIR to one that exists");
}

class TemporaryFile {
 public:
  TemporaryFile() {
    const int file = mkstemp(path_.data());
    if (file < 0) throw std::runtime_error(path_ + " cannot be made: " + strerror(errno));
    close(file);
  }
  ~TemporaryFile() { unlink(path_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }
  // Without the last line break.
  std::string content() const {
    std::ifstream file(path_);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }

 private:
  std::string path_ = temporary_folder() + "/tumblesight_output_XXXXXX";
};

// The additional entries come first: of two entries with one name the first one counts.
std::vector<char*> with_our_environment(const std::vector<std::string>& additional) {
  std::vector<char*> entries;
  for (const std::string& entry : additional) entries.push_back(const_cast<char*>(entry.c_str()));
  for (char** entry = environ; *entry != nullptr; ++entry) entries.push_back(*entry);
  entries.push_back(nullptr);
  return entries;
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
                           const std::string& log_path, int inherited_file,
                           const std::vector<std::string>& environment, const std::string& output_path,
                           ProcessGroup group) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const OutputFile log(log_path), output(output_path);
  const SpawnActions actions(log, output, inherited_file);
  const SpawnAttributes attributes(group);
  const int error = posix_spawnp(&pid_, program.c_str(), actions.get(), attributes.get(), argv.data(),
                                 with_our_environment(environment).data());
  if (error != 0) throw ProgramFailure(program + " cannot be started: " + strerror(error));
}

ChildProcess::~ChildProcess() {
  if (!running()) return;
  kill(pid_, SIGTERM);
  if (wait_for_end(kGrace_s)) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool ChildProcess::running() {
  if (ended_) return false;
  const pid_t result = waitpid(pid_, &status_, WNOHANG);
  ended_ = result != 0;
  // A parent that ignores SIGCHLD gets no exit status.
  status_lost_ = result < 0;
  return !ended_;
}

bool ChildProcess::wait_for_end(double timeout_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (running() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return ended_;
}

bool ChildProcess::ended_well() const {
  return exit_status() == 0;
}

int ChildProcess::exit_status() const {
  return ended_ && !status_lost_ && WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
}

int ChildProcess::ending_signal() const {
  return ended_ && !status_lost_ && WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
}

std::string ChildProcess::how_it_ended() const {
  if (status_lost_) return "ended, but its exit status is lost (is SIGCHLD ignored?)";
  if (WIFSIGNALED(status_)) {
    const int signal = WTERMSIG(status_);
    return "was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
  }
  return "ended with exit status " + std::to_string(WEXITSTATUS(status_));
}

std::string output_of(const std::string& program, const std::vector<std::string>& arguments,
                      double timeout_s) {
  const TemporaryFile output, messages;
  std::string fault;
  ChildProcess process(program, arguments, messages.path(), -1, {}, output.path(), ProcessGroup::kOwn);
  if (!process.wait_for_end(timeout_s))
    fault = "takes longer than " + std::to_string(static_cast<int>(timeout_s)) + " s";
  else if (!process.ended_well())
    fault = process.how_it_ended();
  if (fault.empty()) return output.content();
  for (const std::string& text : {output.content(), messages.content()})
    if (!text.empty()) fault += ": " + text;
  throw ProgramFailure(program + " " + fault);
}

}  // namespace tumblesight::sim
