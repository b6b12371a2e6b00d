// The figures of errors and of registered poses, each described once. CSV, JSON, terminal, Markdown and HTML
// all go by these lists, so that a new figure is one new entry here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/evaluation/metrics.hpp"
#include "sim/evaluation/paper.hpp"
#include "sim/evaluation/pose_errors.hpp"
#include "sim/report/data_table.hpp"

namespace tumblesight::sim {

// One figure of an error summary.
struct SummaryFigure {
  const char* key;        // in CSV and JSON, with its unit
  const char* error_key;  // of its standard error; nullptr: it has none
  bool in_degrees;        // otherwise a share; JSON holds the standard errors of figures in degrees only
  const char* heading;    // in tables
  int decimals;           // in the CSV file, of the figure and of its standard error
  double ErrorSummary::*value;
  double (*error)(const ErrorSummary&);
  std::string (*text)(
      const ErrorSummary&);    // in tables, with unit and standard error; not called without a sequence
  double PaperFigure::*paper;  // nullptr: not published
  std::string (*paper_text)(double paper);
};
const std::vector<SummaryFigure>& summary_figures();
// The figure whose value is this member. Throws std::out_of_range if there is none.
const SummaryFigure& summary_figure(double ErrorSummary::*value);

// One figure of the registered poses of a frame.
struct PoseFigure {
  const char* key;      // in JSON, with its unit; in CSV with "pose_" or "pose_first_" before it
  const char* heading;  // in tables; nullptr: they leave it out
  bool of_first_frame;  // tables have it for the first frame too
  int decimals;         // in the CSV file
  double PoseSummary::*value;
  std::string (*text)(double value);  // in tables, with unit
};
const std::vector<PoseFigure>& pose_figures();
// In tables. "-" where the figure does not exist.
TableCell pose_cell(const PoseFigure& figure, const PoseSummary& summary);

// In tables. "-" without a sequence.
TableCell figure_cell(const SummaryFigure& figure, const ErrorSummary& summary, Mark mark = Mark::kNone);
// "-" where the paper does not have it.
TableCell paper_cell(const SummaryFigure& figure, const PaperFigure& paper);
// "12.69°, 88 %", or "-".
std::string paper_text(const std::optional<PaperFigure>& figure);

}  // namespace tumblesight::sim
