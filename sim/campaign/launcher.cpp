#include "sim/campaign/launcher.hpp"

#include <algorithm>
#include <thread>

namespace tumblesight::sim {

const std::vector<LauncherRow>& launcher_table() {
  static const std::vector<LauncherRow> table{
      {"local", "processes on this machine, one per core", launch_local},
      {"mpi", "mpirun, for machines without a scheduler that share a file system", launch_mpi},
      {"slurm", "a Slurm job array, and a job that makes the report after it", launch_slurm}};
  return table;
}

std::vector<std::string> worker_arguments(const LaunchSettings& settings) {
  return {"campaign", "work", settings.campaign.file, "--out", settings.out, "--supervised"};
}

std::string log_folder(const LaunchSettings& settings) {
  return settings.out + "/logs";
}

std::uint32_t local_jobs(const LaunchSettings& settings) {
  const std::uint32_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::uint32_t wanted = settings.jobs > 0 ? settings.jobs : cores;
  const auto left = static_cast<std::uint32_t>(tasks_left(settings.tasks).size());
  return std::max(1U, std::min(wanted, left));
}

}  // namespace tumblesight::sim
