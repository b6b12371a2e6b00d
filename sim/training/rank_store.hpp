// The store in which the ranks find each other's addresses.
#pragma once

#include <chrono>
#include <string>
#include <torch/csrc/distributed/c10d/Store.hpp>

#include "sim/training/rank_place.hpp"

namespace tumblesight::sim {

// Waits for the other ranks for `timeout`. A file of local ranks, a TCP port of rank 0, or else a new file in
// `folder`. What a killed run has left there is not taken for the new one. Throws std::exception.
c10::intrusive_ptr<c10d::Store> open_rank_store(const RankPlace& place, const std::string& folder,
                                                std::chrono::milliseconds timeout);

}  // namespace tumblesight::sim
