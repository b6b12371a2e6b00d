// Results as JSON. Only figures: the same run gives the same bytes on any number of threads, so times are
// left out.
#pragma once

#include <nlohmann/json.hpp>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// {"mean_deg", "median_deg", "within_20deg", "within_5deg", "mean_standard_error_deg"}; null without a
// sequence.
nlohmann::ordered_json summary_json(const ErrorSummary& summary);

// {"rows": [one a subject and condition], "curves": [one a subject with sweeps]}; without sweeps no "curves".
nlohmann::ordered_json results_json(const Results& results);

}  // namespace tumblesight::sim
