// Results as CSV: one line an estimator in a cell. Only figures, as in the JSON.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// First line: the columns' names. Shares are 0..1; a figure that does not exist is empty.
std::string results_csv(const Results& results);

}  // namespace tumblesight::sim
