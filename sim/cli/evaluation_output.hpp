// What `evaluate`, `merge` and `campaign` show and write of an evaluation, the same for each.
#pragma once

#include <string>

#include "sim/cli/arguments.hpp"
#include "sim/cli/command.hpp"
#include "sim/evaluation/results.hpp"
#include "sim/experiment/experiment.hpp"

namespace tumblesight::sim {

// The files of figures, each empty: none.
struct ResultsFiles {
  std::string json;
  std::string csv;
  std::string report;
};
void add_results_options(Command& command, ResultsFiles& files);  // --csv, --json, --report
OptionFiles files_written(const ResultsFiles& files);

// Prints what is measured.
void announce(const SubjectDescription& subject, const ExperimentSettings& settings);
// Prints the tables of the first subject, and the CRC-32 of all figures.
void print_results(const Results& results);
// Prints how often the runs of all subjects went wrong, with bounds, the worst sequences of each run, and
// what shows them.
void print_campaign(const Results& results);
// Says of each condition with mostly wrong attitudes what they are. Returns the first such cell, or nullptr.
const CellResult* print_mostly_wrong(const SubjectResult& result);
void write_files(const ResultsFiles& files, const Results& results);
// Prints where the report is, if there is one, and an empty line.
void print_report_path(const ResultsFiles& files);

}  // namespace tumblesight::sim
