// Results as the files that `tumblesight evaluate --paper` writes.
#pragma once

#include <string>

#include "sim/evaluation/results.hpp"

namespace tumblesight::sim {

// Results as CSV: one line per estimator and condition.
// The first line names the columns (csv_columns()). Errors are in degrees, shares are 0..1, a figure that
// does not exist is empty. Durations are left out, so that the same run gives the same bytes on any number of
// threads.
std::string results_csv(const Results& results);

// Results as a Markdown document: docs/results.md is one.
std::string results_markdown(const Results& results);

// Results as an HTML page: one self-contained file, figures as inline SVG, no scripts, nothing loaded.
std::string results_page(const Results& results);

// Writes results.md with the text `markdown`, results.csv, results.json and report.html into `folder`. Throws
// as write_file does.
void write_results_files(const std::string& folder, const Results& results, const std::string& markdown);

}  // namespace tumblesight::sim
