// RunAnnouncement: tells the user's other programs on this machine how to join a run: its DDS domain and
// partition. It is a file in the user's RuntimeFolder that only its owner can read, and that the simulator
// keeps locked. The system releases the lock however the simulator ends, so that the file of a killed run is
// not taken for the next run in its domain. Programs that only read the bus, such as the console, find the
// run by this file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/dds/idl/run_secret.hpp"
#include "sim/sil/runtime_folder.hpp"

namespace tumblesight::sim {

class RunAnnouncement {
 public:
  // If the file cannot be written, the run continues without it, and cannot be joined.
  RunAnnouncement(std::uint32_t domain, const hal::dds::RunSecret& secret);
  ~RunAnnouncement();  // removes the file
  RunAnnouncement(const RunAnnouncement&) = delete;
  RunAnnouncement& operator=(const RunAnnouncement&) = delete;

  // Why the run cannot be joined, with the file and the remedy; empty: it can.
  const std::string& failure() const { return failure_; }

 private:
  void write(const RuntimeFolder& folder, const hal::dds::RunSecret& secret);
  bool is_still_ours() const;

  std::string name_, failure_;
  std::optional<RuntimeFolder> folder_;
  int file_ = -1;  // locked until the end of the run
};

struct AnnouncedRun {
  std::uint32_t domain;
  hal::dds::RunSecret secret;
};
// The newest run of this user that is going on, or the one in this domain. `domain`: -1: any. Throws
// SilFailure that names the RuntimeFolder if it cannot be used.
std::optional<AnnouncedRun> announced_run(int domain);

}  // namespace tumblesight::sim
