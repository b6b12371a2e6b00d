// Campaign tasks: a campaign divided into shards of about equal duration, and what of them is done. The shard
// files are the only record of that: whoever has them can go on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/campaign/campaign_file.hpp"
#include "sim/campaign/shard_file.hpp"

namespace tumblesight::sim {

struct CampaignTask {
  std::size_t run = 0;  // index in the campaign
  Shard shard;
  std::string path;  // of its shard file
  std::uint32_t sequences = 0;
};

// In the order in which they are best run: those of all runs side by side, so that every run has figures
// early. `out`: folder of the shard files.
std::vector<CampaignTask> tasks_of(const Campaign& campaign, const std::string& out);
// A shard file in the folder of the task's run that divides it into another number of shards, as after a
// change of its sequences or of sequences_per_task; empty: there is none.
std::string other_division(const CampaignTask& task);
// "near_shoemaker-nominal 3/16"
std::string name_of(const Campaign& campaign, const CampaignTask& task);

// Options of `tumblesight evaluate` for one task.
std::vector<std::string> options_of(const Campaign& campaign, const CampaignTask& task);

// From the size of its file alone. Throws std::runtime_error for a file that is no shard file.
std::uint64_t sequences_done(const CampaignTask& task);
bool is_done(const CampaignTask& task);
std::uint64_t sequences_done(const std::vector<CampaignTask>& tasks);
// Indices.
std::vector<std::size_t> tasks_left(const std::vector<CampaignTask>& tasks);

}  // namespace tumblesight::sim
