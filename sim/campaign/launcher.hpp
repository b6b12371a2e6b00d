// Launcher: how the workers of a campaign are started: as processes on this machine, by mpirun, or by Slurm.
// None of them schedules anything itself.
//
// To add a way: its class and its row in launcher.cpp, its file, and its test.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/campaign/campaign_tasks.hpp"

namespace tumblesight::sim {

struct LaunchSettings {
  std::string program;  // `tumblesight` as the workers call it, on every machine
  Campaign campaign;
  std::string out;                   // absolute folder of shard files and logs
  std::uint32_t jobs = 0;            // workers at a time; 0: one per core of this machine, or Slurm decides
  std::vector<std::string> options;  // further ones of mpirun or sbatch
  std::vector<CampaignTask> tasks;
  // Whether the user wants this program to end: nothing is started any more.
  std::function<bool()> told_to_stop = [] { return false; };
};

class Launcher {
 public:
  virtual ~Launcher() = default;
  // Of what was started, for the user: "2 processes", "Slurm job 17".
  virtual std::string started() const = 0;
  // Whether work still goes on. Starts again what died, a bounded number of times.
  virtual bool running() = 0;
  // Whether the work goes on when this program ends.
  virtual bool outlives_us() const { return false; }
  // What went wrong, and where more is to be read; empty: nothing.
  virtual std::string fault() const = 0;
};

struct LauncherRow {
  const char* name;         // on the command line
  const char* explanation;  // one line
  // Starts the workers. Throws std::runtime_error that names what is missing, and the remedy.
  std::unique_ptr<Launcher> (*launch)(const LaunchSettings& settings);
};
const std::vector<LauncherRow>& launcher_table();

std::unique_ptr<Launcher> launch_local(const LaunchSettings& settings);
std::unique_ptr<Launcher> launch_mpi(const LaunchSettings& settings);
std::unique_ptr<Launcher> launch_slurm(const LaunchSettings& settings);

// The arguments of `tumblesight` that start a worker.
std::vector<std::string> worker_arguments(const LaunchSettings& settings);
// Folder of the workers' messages.
std::string log_folder(const LaunchSettings& settings);
// settings.jobs, or one per core; never more than there are tasks.
std::uint32_t local_jobs(const LaunchSettings& settings);

}  // namespace tumblesight::sim
