#include "sim/campaign/campaign_worker.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace tumblesight::sim {

namespace {

class Worker {
 public:
  Worker(const Campaign& campaign, const std::vector<CampaignTask>& tasks,
         const std::function<void(const CampaignTask&)>& run,
         const std::function<void(const std::string&)>& say)
      : campaign_(campaign), tasks_(tasks), run_(run), say_(say), has_failed_(tasks.size()) {}

  // Goes through the tasks once. Returns whether one was done.
  bool pass(const std::optional<Shard>& part) {
    const std::size_t before = outcome_.done;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      const bool is_ours = !part || i % part->count == part->index;
      if (is_ours && !has_failed_[i] && is_left(tasks_[i]) && !is_in_use(tasks_[i].path)) try_task(i);
    }
    return outcome_.done > before;
  }
  const WorkerOutcome& outcome() const { return outcome_; }

 private:
  // A file that cannot be read is tried, which says why.
  static bool is_left(const CampaignTask& task) {
    try {
      return !is_done(task);
    } catch (const std::runtime_error&) {
      return true;
    }
  }

  void try_task(std::size_t i) {
    const std::string name = name_of(campaign_, tasks_[i]);
    try {
      run_(tasks_[i]);
      if (!is_done(tasks_[i])) throw std::runtime_error("its shard file is not complete");
      ++outcome_.done;
      say_(fmt::format("{} is done", name));
    } catch (const ShardInUse&) {
      say_(fmt::format("{} is run by another worker", name));
    } catch (const std::exception& error) {
      has_failed_[i] = true;
      outcome_.failures.push_back(fmt::format("{}: {}", name, error.what()));
      say_("FAILED: " + outcome_.failures.back());
    }
  }

  const Campaign& campaign_;
  const std::vector<CampaignTask>& tasks_;
  const std::function<void(const CampaignTask&)>& run_;
  const std::function<void(const std::string&)>& say_;
  std::vector<bool> has_failed_;
  WorkerOutcome outcome_;
};

}  // namespace

WorkerOutcome work(const Campaign& campaign, const std::vector<CampaignTask>& tasks,
                   const std::optional<Shard>& part, const std::function<void(const CampaignTask&)>& run,
                   const std::function<void(const std::string&)>& say) {
  Worker worker(campaign, tasks, run, say);
  // Again, for tasks of workers that have died meanwhile.
  while (worker.pass(part)) {
  }
  return worker.outcome();
}

}  // namespace tumblesight::sim
