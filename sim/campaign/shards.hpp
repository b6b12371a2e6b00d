// Shards: an evaluation run in parts, and the parts put together again. The figures are those of one process,
// bit for bit, whatever the number of parts and whatever their order.
#pragma once

#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/campaign/shard_file.hpp"

namespace tumblesight::sim {

// Steps of the sequences of a shard, see steps_of(), out of which run_shard() counts.
std::uint64_t steps_of(const ExperimentSettings& settings, const Shard& shard);

// Runs the sequences of the shard that `file` does not hold yet. `progress`: steps done, of the whole shard.
// Throws as run_chosen() and ShardWriter do.
void run_shard(const Subject& subject, const ExperimentSettings& settings, const Shard& shard,
               ShardWriter& file, const std::function<void(std::uint64_t)>& progress);

// Of one evaluation.
struct MergedShards {
  ExperimentIdentity identity;
  std::string command;             // of the evaluation in one process
  std::vector<std::string> notes;  // what a reader of the figures has to know
  std::set<std::string> commits;   // of the programs that made the shards
  SubjectResult figures;
};

// Builds of one version can differ: adds a note if the commits do.
void note_builds(const std::set<std::string>& commits, std::vector<std::string>& notes);

// kPartial: figures of the sequences that there are, with a note of how many are missing.
enum class MergeMode { kComplete, kPartial };

// No sequence is done in any of the files.
struct NothingDone : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws NothingDone, and std::runtime_error that names the files and the remedy if one cannot be read or is
// no shard file, if they are of different evaluations, if a sequence is in two of them, or, but for kPartial,
// in none.
MergedShards merge_shards(const std::vector<std::string>& paths, MergeMode mode = MergeMode::kComplete);

}  // namespace tumblesight::sim
