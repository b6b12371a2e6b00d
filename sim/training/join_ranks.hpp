// How a process becomes one of several ranks.
#pragma once

#include <memory>
#include <string>

#include "sim/training/rank_place.hpp"
#include "sim/training/ranks.hpp"

namespace tumblesight::sim {

// Whether this build can have several ranks: it needs Gloo's headers (Debian: libgloo-dev).
bool can_have_several_ranks();

// Finds the other ranks and connects with them; with one rank, returns at once. `folder`: where ranks without
// a MASTER_ADDR meet; they all see it. `timeout_s`: after so long without an answer a rank counts as lost.
// Throws RankLost, or std::runtime_error if this build cannot have several ranks.
std::shared_ptr<Ranks> join_ranks(const RankPlace& place, const std::string& folder, double timeout_s);

}  // namespace tumblesight::sim
