#include "sim/campaign/campaign_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace tumblesight::sim {
namespace {

std::uint32_t shards_of(const Campaign& campaign, const CampaignRun& run) {
  const std::uint32_t shards =
      (run.sequences + campaign.sequences_per_task - 1) / campaign.sequences_per_task;
  return std::min(shards, kMostShards);
}

// Where in its run a task stands, 0..1.
double place_of(const CampaignTask& task) {
  return (task.shard.index + 0.5) / task.shard.count;
}

}  // namespace

std::vector<CampaignTask> tasks_of(const Campaign& campaign, const std::string& out) {
  std::vector<CampaignTask> tasks;
  for (std::size_t i = 0; i < campaign.runs.size(); ++i) {
    const CampaignRun& run = campaign.runs[i];
    const std::uint32_t count = shards_of(campaign, run);
    for (std::uint32_t index = 0; index < count; ++index) {
      const Shard shard{index, count};
      tasks.push_back({i, shard, fmt::format("{}/{}/{:04}_of_{:04}.shard", out, run.name, index, count),
                       static_cast<std::uint32_t>(sequences_of(shard, run.sequences).size())});
    }
  }
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const CampaignTask& a, const CampaignTask& b) { return place_of(a) < place_of(b); });
  return tasks;
}

std::string other_division(const CampaignTask& task) {
  namespace fs = std::filesystem;
  const std::string of_ours = fmt::format("_of_{:04}.shard", task.shard.count);
  std::error_code no_folder;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(fs::path(task.path).parent_path(), no_folder)) {
    const std::string name = entry.path().filename().string();
    const std::size_t of = name.find("_of_");
    if (of != std::string::npos && entry.path().extension() == ".shard" && name.substr(of) != of_ours)
      return entry.path().string();
  }
  return {};
}

std::string name_of(const Campaign& campaign, const CampaignTask& task) {
  return campaign.runs[task.run].name + " " + to_string(task.shard);
}

std::vector<std::string> options_of(const Campaign& campaign, const CampaignTask& task) {
  std::vector<std::string> options = campaign.runs[task.run].options;
  for (const std::string& option :
       {std::string("--no-baseline"), std::string("--threads"), std::string("1"), std::string("--shard"),
        to_string(task.shard), std::string("--shard-file"), task.path})
    options.push_back(option);
  return options;
}

std::uint64_t sequences_done(const CampaignTask& task) {
  return std::min<std::uint64_t>(records_in(task.path), task.sequences);
}

bool is_done(const CampaignTask& task) {
  return sequences_done(task) == task.sequences;
}

std::uint64_t sequences_done(const std::vector<CampaignTask>& tasks) {
  std::uint64_t done = 0;
  for (const CampaignTask& task : tasks) done += sequences_done(task);
  return done;
}

std::vector<std::size_t> tasks_left(const std::vector<CampaignTask>& tasks) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < tasks.size(); ++i)
    if (!is_done(tasks[i])) left.push_back(i);
  return left;
}

}  // namespace tumblesight::sim
