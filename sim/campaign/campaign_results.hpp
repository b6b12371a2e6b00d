// Campaign results: the figures of all runs of a campaign, from their shard files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/campaign/campaign_tasks.hpp"
#include "sim/campaign/shards.hpp"

namespace tumblesight::sim {

// A subject per target, mesh, model, inertia and number of frames, with a cell per run: among the cells, the
// disturbed runs or the runs with effects. The titles of the subjects differ. Runs without a finished
// sequence are left out. `progress`: runs that are merged. Throws as merge_shards() does.
Results campaign_results(const Campaign& campaign, const std::vector<CampaignTask>& tasks, MergeMode mode,
                         const std::function<void(std::size_t)>& progress);

}  // namespace tumblesight::sim
