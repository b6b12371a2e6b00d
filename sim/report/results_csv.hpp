// Results as CSV: one line per estimator and condition.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// The first line names the columns (csv_columns()). Errors are in degrees, shares are 0..1, a figure that
// does not exist is empty. Durations are left out, so that the same run gives the same bytes on any number of
// threads.
std::string results_csv(const Results& results);

}  // namespace tumblesight::sim
