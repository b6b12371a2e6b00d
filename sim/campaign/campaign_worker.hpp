// Campaign worker: one of the processes that run a campaign's tasks. Workers share nothing but the shard
// files: each takes the next task that is neither done nor in the hands of another one. None is told how many
// there are, and one that dies leaves its task to the others.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/campaign/campaign_tasks.hpp"

namespace tumblesight::sim {

struct WorkerOutcome {
  std::size_t done = 0;
  std::vector<std::string> failures;  // task and reason
};

// Runs tasks until none is left, or those that are left are run by others. `part`: only the tasks of which
// the index belongs to it, for a scheduler that limits the time of each part. `run`: runs a task; what it
// throws is a failure of that task, and the next one follows. `say`: told about every task.
WorkerOutcome work(const Campaign& campaign, const std::vector<CampaignTask>& tasks,
                   const std::optional<Shard>& part, const std::function<void(const CampaignTask&)>& run,
                   const std::function<void(const std::string&)>& say);

}  // namespace tumblesight::sim
