// FlightProcess: the flight program as a child process, which ends with this object at the latest.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace tumblesight::sim {

class FlightProcess {
 public:
  // `log_path`: file for its messages; empty: our own output. `inherited_file`: descriptor that the child
  // inherits under the same number; -1: none. `environment`: "NAME=value" entries added to ours. Throws
  // SilFailure if the program cannot be started.
  FlightProcess(const std::string& program, const std::vector<std::string>& arguments,
                const std::string& log_path, int inherited_file = -1,
                const std::vector<std::string>& environment = {});
  // Sends SIGTERM, and after two seconds SIGKILL.
  ~FlightProcess();
  FlightProcess(const FlightProcess&) = delete;
  FlightProcess& operator=(const FlightProcess&) = delete;

  bool running();
  // Waits until it has ended (true) or the timeout is over (false).
  bool wait_for_end(double timeout_s);
  bool ended() const { return ended_; }
  bool ended_well() const;           // ended with exit status 0
  int exit_status() const;           // -1: it has not ended by itself
  std::string how_it_ended() const;  // "ended with exit status 4: the simulator is gone"
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
  bool ended_ = false;
  bool status_lost_ = false;  // it ended, but the exit status is unknown
  int status_ = 0;
};

}  // namespace tumblesight::sim
