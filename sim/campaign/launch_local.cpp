#include <fmt/format.h>

#include "sim/campaign/launcher.hpp"
#include "sim/host/child_process.hpp"
#include "sim/host/end_with_starter.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kMostRestarts =
    3;  // of all workers together: a task that kills its worker must not go on forever

struct LocalWorker {
  std::unique_ptr<ChildProcess> process;
  std::string log;
  bool counted = false;  // among those that died
};

class LocalWorkers final : public Launcher {
 public:
  explicit LocalWorkers(const LaunchSettings& settings) : settings_(settings) {
    for (std::uint32_t i = 0; i < local_jobs(settings); ++i) start();
    started_ = counted(workers_.size(), "worker");
  }

  std::string started() const override { return started_; }
  std::string fault() const override { return fault_; }
  bool running() override {
    bool any = false;
    int to_start = 0;
    for (LocalWorker& worker : workers_) {
      if (worker.process->running()) {
        any = true;
      } else if (!worker.process->ended_well() && !worker.counted) {
        worker.counted = true;
        fault_ = fmt::format("a worker {}; its messages: {}", worker.process->how_it_ended(), worker.log);
        if (++deaths_ <= kMostRestarts) ++to_start;
      }
    }
    for (int i = 0; i < to_start; ++i) start();
    return any || to_start > 0;
  }

 private:
  void start() {
    const std::string log = fmt::format("{}/local_{}.log", log_folder(settings_), workers_.size());
    workers_.push_back({std::make_unique<ChildProcess>(settings_.program, worker_arguments(settings_), log,
                                                       -1, std::vector<std::string>{starter_environment()}),
                        log});
  }

  const LaunchSettings settings_;
  std::vector<LocalWorker> workers_;
  std::string started_;
  int deaths_ = 0;
  std::string fault_;
};

}  // namespace

std::unique_ptr<Launcher> launch_local(const LaunchSettings& settings) {
  return std::make_unique<LocalWorkers>(settings);
}

}  // namespace tumblesight::sim
