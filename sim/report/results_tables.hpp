// The tables of results, as data: terminal, Markdown document and HTML page show the same ones.
#pragma once

#include <string>
#include <vector>

#include "sim/evaluation/results.hpp"
#include "sim/report/data_table.hpp"
#include "sim/report/results_columns.hpp"

namespace tumblesight::sim {

// The errors under one condition: RCNN, CNN and, where it was run, template matching.
DataTable cell_table(const std::string& target, const CellResult& cell);

// A line per condition, with the columns that belong to `table`; overviews have a title above each
// subject's lines.
DataTable conditions_table(const std::vector<SubjectResult>& subjects, ConditionTables table);

// The registered poses of the conditions of a subject.
DataTable poses_table(const SubjectResult& subject);

// All runs of a subject: cells, disturbed runs, runs with effects.
std::vector<const CellResult*> all_cells(const SubjectResult& subject);
// "nominal, noise=2, lost-frames 1"
std::string run_name(const CellResult& cell);
// Network and pose in the last frame, a line per run.
DataTable accuracy_table(const SubjectResult& subject);
// How often the last frame goes wrong, with bounds: a line per run.
DataTable rare_events_table(const SubjectResult& subject);
// The worst sequences of a run, a line each, with what replays them.
DataTable worst_sequences_table(const CellResult& cell);

// Mean of the RCNN, a line per frame, a column per condition.
DataTable frames_table(const SubjectResult& subject);
// A line per point with sequences. `at`: what the curve runs over; its values are multiplied by `scale`.
DataTable curve_table(const std::string& at, const Curve& curve, double scale = 1.0);
DataTable histogram_table(const CellResult& cell);
DataTable confusion_table(const SubjectResult& subject);
DataTable reliability_table(const CellResult& cell);
// Rejection of estimates by a threshold on their expected error.
DataTable detection_table(const SubjectResult& subject);
// A line per disturbed run, with its bar.
DataTable disturbed_table(const SubjectResult& subject);
// A line per run that has a goal of the registered pose or does not show the target: what it reached, the
// goal, and what of the trust in it is missed. Nothing without such runs.
DataTable goals_table(const SubjectResult& subject);
DataTable checks_table(const SubjectResult& subject);

}  // namespace tumblesight::sim
