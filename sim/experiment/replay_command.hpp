// Replay command: from the command of an evaluation to the one that shows a sequence of it.
#pragma once

#include <string>

#include "sim/world/scenario/condition.hpp"

namespace tumblesight::sim {

// "tumblesight evaluate --target x --condition nominal,degraded --csv a.csv" gives, for kDegraded,
// "tumblesight simulate --target x --condition degraded --only ": the index of the sequence is to follow.
// Options that only `evaluate` has are left out.
std::string replay_command(const std::string& evaluate_command, Condition condition);

}  // namespace tumblesight::sim
