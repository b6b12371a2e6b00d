#include "sim/campaign/campaign_worker.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace tumblesight::sim {

WorkerOutcome work(const Campaign& campaign, const std::vector<CampaignTask>& tasks,
                   const std::optional<Shard>& part, const std::function<void(const CampaignTask&)>& run,
                   const std::function<void(const std::string&)>& say) {
  WorkerOutcome outcome;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const CampaignTask& task = tasks[i];
    const bool is_ours = !part || i % part->count == part->index;
    if (!is_ours || is_done(task) || is_in_use(task.path)) continue;
    const std::string name = name_of(campaign, task);
    try {
      run(task);
      ++outcome.done;
      say(fmt::format("{} is done", name));
    } catch (const ShardInUse&) {
      say(fmt::format("{} is run by another worker", name));
    } catch (const std::exception& error) {
      outcome.failures.push_back(fmt::format("{}: {}", name, error.what()));
      say("FAILED: " + outcome.failures.back());
    }
  }
  return outcome;
}

}  // namespace tumblesight::sim
