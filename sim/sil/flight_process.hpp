// FlightProcess: the flight program as a child process. It never outlives this object.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace tumblesight::sim {

class FlightProcess {
 public:
  // `log_path`: file for its messages; empty: they come out with our own. `inherited_file`: descriptor that
  // stays open in it, under its number; -1: none. Throws SilFailure if it cannot be started.
  FlightProcess(const std::string& program, const std::vector<std::string>& arguments,
                const std::string& log_path, int inherited_file = -1);
  // Asks it to end, and kills it if it does not within two seconds.
  ~FlightProcess();
  FlightProcess(const FlightProcess&) = delete;
  FlightProcess& operator=(const FlightProcess&) = delete;

  bool running();
  // True once it has ended.
  bool wait_for_end(double timeout_s);
  bool ended() const { return ended_; }
  bool ended_well() const;           // ended, known to be with exit status 0
  std::string how_it_ended() const;  // "ended with exit status 4: the simulator is gone"
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
  bool ended_ = false;
  bool status_lost_ = false;  // ended, but nobody can tell how
  int status_ = 0;
};

}  // namespace tumblesight::sim
