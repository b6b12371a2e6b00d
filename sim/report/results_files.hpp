// The set of files that `tumblesight evaluate --paper` writes.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// Writes results.md, results.csv, results.json and report.html into `folder`. Throws as write_file does.
void write_results_files(const std::string& folder, const Results& results);

}  // namespace tumblesight::sim
