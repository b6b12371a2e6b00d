// RunControl: accepts requests from the user's other programs to a running simulation: telecommands, which
// the run numbers and signs, and faults. It is a socket in the user's RuntimeFolder that only its owner can
// use, beside the announcement of the run (RunAnnouncement).
//
// A request is a line of JSON, and so is its answer:
//   {"function": 3, "arguments": "02"}      a function code and its arguments as hexadecimal digits
//   {"fault": "debris", "strength": 1.5, "steps": 5}     fault_table(); without strength where it has none
//   {"step": 41}                            the step in which it takes effect
//   {"error": "..."}                        it was not taken
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/operations/signed_telecommand.hpp"
#include "sim/recording/step_source.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/frame_faults.hpp"
#include "sim/sil/runtime_folder.hpp"

namespace tumblesight::sim {

// What was requested for one step.
struct RunRequests {
  std::vector<Telecommand> commands;
  std::vector<InjectedFault> faults;  // that have begun
};

class RunControl {
 public:
  static constexpr std::size_t kMostClients = 8;
  static constexpr std::size_t kMostBytes = 8192;   // of a request
  static constexpr std::size_t kMostCommands = 16;  // per step; half of what a step may carry
  static constexpr std::size_t kMostFaults = 16;    // per step

  // If the socket cannot be made, the run continues without it, and accepts no requests.
  explicit RunControl(std::uint32_t domain);
  ~RunControl();  // removes the socket
  RunControl(const RunControl&) = delete;
  RunControl& operator=(const RunControl&) = delete;

  // Why the run accepts no requests, with the file and the remedy; empty: it does.
  const std::string& failure() const { return failure_; }
  // What was requested since the last call. Does not wait. `step`: of the answers, the next one of `source`.
  // Faults begin in `frames` or `source`.
  RunRequests take(std::uint32_t step, FrameFaults& frames, StepSource& source);

 private:
  struct Client {
    int socket;
    std::string received;
  };
  void listen_in(const RuntimeFolder& folder, const std::string& name);
  void accept_clients();
  struct Step {
    std::uint32_t k;
    FrameFaults& frames;
    StepSource& source;
    RunRequests requests;
  };
  static void take_request(const std::string& line, Step& step);
  static void take_fault(const InjectedFault& fault, Step& step);
  static std::string answer_to(const std::string& line, Step& step);
  static bool serve(Client& client, Step& step);

  std::string path_, failure_;
  int socket_ = -1;
  std::vector<Client> clients_;
};

// More programs ask a run than it can serve in time. Nothing was sent.
class RunIsBusy : public SilFailure {
 public:
  using SilFailure::SilFailure;
};

// Sends a request to the run in a domain and waits for its answer, at most `timeout_ms` in all. Throws
// SilFailure that says why there is none, RunIsBusy among them, and std::invalid_argument for a request that
// is too long.
std::string ask_run(std::uint32_t domain, const std::string& request, int timeout_ms);

}  // namespace tumblesight::sim
