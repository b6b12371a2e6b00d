// What a campaign consists of, and whether what is there of it still belongs to it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/campaign/campaign_tasks.hpp"
#include "sim/cli/evaluate_arguments.hpp"

namespace tumblesight::sim {

// A campaign and where it stands.
struct OpenCampaign {
  Campaign campaign;
  std::string out;
  std::vector<CampaignTask> tasks;

  std::uint64_t sequences() const {
    std::uint64_t all = 0;
    for (const CampaignTask& task : tasks) all += task.sequences;
    return all;
  }
};

// Of `tumblesight evaluate`, for one task.
EvaluateArguments arguments_of(const OpenCampaign& open, const CampaignTask& task);

// Every run and what there is of it, before the first one starts. Throws std::invalid_argument that names
// line and run: a key or a value that is not allowed, the sequences of another run, or shard files of another
// experiment.
void check(const OpenCampaign& open);
// The same for the options alone, so that it needs no mesh.
void require_same_options(const OpenCampaign& open);

}  // namespace tumblesight::sim
