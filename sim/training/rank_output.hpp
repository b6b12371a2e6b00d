// What a rank shows: rank 0 everything, the others only why they fail.
#pragma once

#include <functional>

namespace tumblesight::sim {

// Runs `job`. On another rank than 0 its output on stdout and stderr is dropped meanwhile. Throws as `job`
// does; the message of a std::runtime_error then begins with the rank.
int run_quietly_unless_first(int rank, const std::function<int()>& job);

}  // namespace tumblesight::sim
