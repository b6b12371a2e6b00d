// Ranks in threads of the test's process, connected as those of several processes are.
#pragma once

#include <ATen/Parallel.h>

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "sim/training/join_ranks.hpp"

namespace tumblesight::sim {

inline constexpr double kTestTimeout_s = 20.0;

// Runs `job` once per rank, all at a time. `store_file`: does not exist yet. Throws what a job throws.
inline void run_ranks(int count, const std::string& store_file,
                      const std::function<void(const std::shared_ptr<Ranks>&)>& job) {
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
  std::vector<std::thread> threads;
  for (int rank = 0; rank < count; ++rank) {
    threads.emplace_back([&, rank] {
      at::set_num_threads(1);  // of this thread
      try {
        RankPlace place;
        place.rank = rank;
        place.count = count;
        place.store_file = store_file;
        job(join_ranks(place, "", kTestTimeout_s));
      } catch (...) {
        errors[static_cast<std::size_t>(rank)] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace tumblesight::sim
