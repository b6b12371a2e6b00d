// FlightProcess: the flight program as a child process, which ends with this object at the latest.
#pragma once

#include <string>
#include <vector>

#include "sim/host/child_process.hpp"

namespace tumblesight::sim {

class FlightProcess : public ChildProcess {
 public:
  // As ChildProcess. Throws SilFailure if the program cannot be started.
  FlightProcess(const std::string& program, const std::vector<std::string>& arguments,
                const std::string& log_path, int inherited_file = -1,
                const std::vector<std::string>& environment = {});

  std::string how_it_ended() const;  // "ended with exit status 4: the simulator is gone"
};

}  // namespace tumblesight::sim
