// RankPlace: which rank of how many this process is, and how the ranks find each other, as the environment
// that their launcher has set says. Described in docs/training.md.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tumblesight::sim {

struct RankPlace {
  int rank = 0;
  int count = 1;
  std::string store_file;   // of ranks that run_local_ranks() has started; empty: of others
  std::string master_host;  // where rank 0 listens; empty: the ranks meet in the folder of the training
  int master_port = 0;
  std::string store_prefix;         // of the keys in the store
  bool launcher_has_store = false;  // at master_host, in place of rank 0
};

// Local ranks, then RANK and WORLD_SIZE, then Open MPI, then a task of a Slurm step: the first of these that
// the environment names. Outside all of them, or with one rank, the process is alone. Throws
// std::runtime_error that names the variable if they do not go together.
RankPlace rank_place(const std::function<const char*(const char*)>& variable);
RankPlace rank_place();  // of this process's environment

// NAME=VALUE for rank_place(), of a rank that is started with this store's file.
std::vector<std::string> local_rank_environment(int rank, int count, const std::string& store_file);

}  // namespace tumblesight::sim
