// `tumblesight evaluate --paper`: every table and figure of the paper, for every target that has a model.
#pragma once

#include "sim/cli/evaluate_arguments.hpp"

namespace tumblesight::sim {

// Writes results.md, results.csv, results.json and report.html after every subject, so that an interrupted
// run keeps what it has measured.
void evaluate_paper(const EvaluateArguments& arguments);

}  // namespace tumblesight::sim
