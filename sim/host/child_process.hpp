// ChildProcess: another program that runs beside this one, and ends with this object at the latest.
#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tumblesight::sim {

// A program that cannot be started, or has failed. Its files are another matter: std::runtime_error.
struct ProgramFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Of the terminal: Ctrl-C reaches the processes of its foreground group.
enum class ProcessGroup { kOurs, kOwn };

class ChildProcess {
 public:
  // `program`: a path, or a name that is looked for in PATH. `log_path`: file for its messages; empty: our
  // own output. `output_path`: file for its standard output, if that is another one. `inherited_file`:
  // descriptor that the child inherits under the same number; -1: none. `environment`: "NAME=value" entries
  // added to ours. `group`: kOwn lets it finish when the user presses Ctrl-C. Throws ProgramFailure if it
  // cannot be started, and std::runtime_error that names a file that cannot be written.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
               const std::string& log_path, int inherited_file = -1,
               const std::vector<std::string>& environment = {}, const std::string& output_path = "",
               ProcessGroup group = ProcessGroup::kOurs);
  // Sends SIGTERM, and after two seconds SIGKILL.
  virtual ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool running();
  // Waits until it has ended (true) or the timeout is over (false).
  bool wait_for_end(double timeout_s);
  bool ended() const { return ended_; }
  bool ended_well() const;           // ended with exit status 0
  int exit_status() const;           // -1: it has not ended by itself
  int ending_signal() const;         // 0: no signal has ended it
  std::string how_it_ended() const;  // "ended with exit status 4", "was ended by signal 9 (Killed)"
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
  bool ended_ = false;
  bool status_lost_ = false;  // it ended, but the exit status is unknown
  int status_ = 0;
};

// What a program prints on its standard output, without the last line break. Ctrl-C does not reach it. Throws
// ProgramFailure with all that it printed if it cannot be started, fails, or takes longer than `timeout_s`.
std::string output_of(const std::string& program, const std::vector<std::string>& arguments,
                      double timeout_s);

}  // namespace tumblesight::sim
