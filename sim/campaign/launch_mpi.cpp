#include <fmt/format.h>

#include <stdexcept>

#include "sim/campaign/launcher.hpp"
#include "sim/process/child_process.hpp"
#include "sim/terminal/text.hpp"

namespace tumblesight::sim {
namespace {

// The workers do not talk to each other, so they need no MPI library: mpirun only starts them.
class MpiWorkers final : public Launcher {
 public:
  explicit MpiWorkers(const LaunchSettings& settings)
      : jobs_(local_jobs(settings)),
        log_(log_folder(settings) + "/mpirun.log"),
        mpirun_("mpirun", arguments_of(settings), log_) {}

  std::string started() const override { return fmt::format("mpirun with {}", counted(jobs_, "worker")); }
  bool running() override { return mpirun_.running(); }
  std::string fault() const override {
    if (!mpirun_.ended() || mpirun_.ended_well()) return {};
    return fmt::format("mpirun {}; its messages: {}", mpirun_.how_it_ended(), log_);
  }

 private:
  std::vector<std::string> arguments_of(const LaunchSettings& settings) const {
    std::vector<std::string> arguments{"-n", std::to_string(jobs_)};
    arguments.insert(arguments.end(), settings.options.begin(), settings.options.end());
    arguments.push_back(settings.program);
    for (const std::string& argument : worker_arguments(settings)) arguments.push_back(argument);
    return arguments;
  }

  const std::uint32_t jobs_;
  const std::string log_;
  ChildProcess mpirun_;
};

}  // namespace

std::unique_ptr<Launcher> launch_mpi(const LaunchSettings& settings) {
  try {
    return std::make_unique<MpiWorkers>(settings);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        fmt::format("{}; install an MPI (Debian: openmpi-bin), or use --on local", error.what()));
  }
}

}  // namespace tumblesight::sim
