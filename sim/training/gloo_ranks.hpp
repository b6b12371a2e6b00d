// Several ranks, connected by LibTorch's c10d with Gloo over TCP. Those of one machine add up gradients in
// shared memory.
#pragma once

#include <memory>
#include <string>

#include "sim/training/rank_place.hpp"
#include "sim/training/ranks.hpp"

namespace tumblesight::sim {

// As join_ranks(), for place.count > 1.
std::shared_ptr<Ranks> join_gloo_ranks(const RankPlace& place, const std::string& folder, double timeout_s);

}  // namespace tumblesight::sim
