// Results as JSON. Durations are left out, so that the same run gives the same bytes on any number of
// threads.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// {"rows": [one per subject and condition], "curves": [one per subject with sweeps]}; no "curves" without
// sweeps.
nlohmann::ordered_json results_json(const Results& results);

}  // namespace tumblesight::sim
