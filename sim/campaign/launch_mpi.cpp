#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "sim/campaign/launcher.hpp"
#include "sim/host/child_process.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kLongestQuestion_s = 30.0;

// mpirun does not end when this program is killed, unless the kernel tells it. `setpriv` is part of
// util-linux.
std::vector<std::string> ending_with_us(std::vector<std::string> command) {
  const std::vector<std::string> with_us{"--pdeathsig", "TERM"};
  std::vector<std::string> trial = with_us;
  trial.push_back("true");
  try {
    (void)output_of("setpriv", trial, kLongestQuestion_s);
  } catch (const ProgramFailure&) {
    return command;
  }
  command.insert(command.begin(), with_us.begin(), with_us.end());
  command.insert(command.begin(), "setpriv");
  return command;
}

// The workers do not talk to each other, so they need no MPI library: mpirun only starts them.
class MpiWorkers final : public Launcher {
 public:
  explicit MpiWorkers(const LaunchSettings& settings)
      : jobs_(local_jobs(settings)),
        log_(log_folder(settings) + "/mpirun.log"),
        mpirun_(started_with(ending_with_us(command_of(settings)))) {}

  std::string started() const override { return fmt::format("mpirun with {}", counted(jobs_, "worker")); }
  bool running() override { return mpirun_->running(); }
  std::string fault() const override {
    if (!mpirun_->ended() || mpirun_->ended_well()) return {};
    return fmt::format("mpirun {}; its messages: {}", mpirun_->how_it_ended(), log_);
  }

 private:
  std::vector<std::string> command_of(const LaunchSettings& settings) const {
    std::vector<std::string> command{"mpirun", "-n", std::to_string(jobs_)};
    command.insert(command.end(), settings.options.begin(), settings.options.end());
    command.push_back(settings.program);
    for (const std::string& argument : worker_arguments(settings)) command.push_back(argument);
    return command;
  }
  std::unique_ptr<ChildProcess> started_with(const std::vector<std::string>& command) const {
    return std::make_unique<ChildProcess>(command.front(),
                                          std::vector<std::string>(command.begin() + 1, command.end()), log_);
  }

  const std::uint32_t jobs_;
  const std::string log_;
  const std::unique_ptr<ChildProcess> mpirun_;
};

}  // namespace

std::unique_ptr<Launcher> launch_mpi(const LaunchSettings& settings) {
  try {
    (void)output_of("mpirun", {"--version"}, kLongestQuestion_s);
  } catch (const ProgramFailure& error) {
    throw std::runtime_error(
        fmt::format("{}; install an MPI (Debian: openmpi-bin), or use --on local", error.what()));
  }
  return std::make_unique<MpiWorkers>(settings);
}

}  // namespace tumblesight::sim
