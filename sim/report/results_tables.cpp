#include "sim/report/results_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/evaluation/checks.hpp"
#include "sim/evaluation/disturbed_runs.hpp"
#include "sim/evaluation/pose_goals.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/host/text.hpp"
#include "sim/report/error_tables.hpp"

namespace tumblesight::sim {
namespace {

using Cells = std::vector<TableCell>;

std::vector<std::string> condition_header(ConditionTables table) {
  std::vector<std::string> header;
  for (const ConditionColumn& column : condition_columns()) {
    if ((column.tables & table) != 0) header.push_back(column.heading);
  }
  return header;
}

Cells condition_cells(const ResultRow& row, ConditionTables table) {
  Cells cells;
  for (const ConditionColumn& column : condition_columns()) {
    if ((column.tables & table) != 0) cells.push_back(column.cell(row));
  }
  return cells;
}

std::string name_of(const CellResult& cell) {
  const std::string other = differences_from_paper(cell);
  return other.empty() ? to_string(cell.condition) : other;
}

// "-" where the figure does not exist.
std::string text_or_dash(double value, std::string (*text)(double)) {
  return std::isnan(value) ? "-" : text(value);
}
std::string ratio_text(double ratio) {
  return std::isnan(ratio) ? "-" : fmt::format("{:.2f}", ratio);
}
std::string pose_error_text(double deg) {
  return std::isnan(deg) ? "-" : fmt::format("{:.3f}°", deg);
}

Cells goal_cells(const CellResult& cell, const std::optional<PoseGoal>& goal) {
  const PoseSummary& pose = cell.pose;
  const bool shown = show_the_target(cell.effects);
  const bool reached = goal ? meets(pose, *goal) : !shown;
  const std::string missed = missed_trust(cell);
  const auto mark = [](bool met) { return met ? Mark::kMet : Mark::kMissed; };
  const bool any_right = shown && cell.rcnn.within_20deg > 0.0;
  Cells cells{{name_of(cell)}, {std::to_string(cell.sequences)}};
  cells.push_back({shown ? percent_text(cell.rcnn.within_20deg) : "-"});
  cells.push_back({shown ? pose_error_text(pose.mean_within_20_deg) : "-"});
  cells.push_back({shown ? percent_text(pose.within_20deg, pose.count) : "-"});
  cells.push_back({goal ? text_of(*goal) : "-", mark(reached)});
  cells.push_back({percent_text(cell.rcnn.wrong_and_valid)});
  cells.push_back({any_right ? percent_text(cell.rcnn.right_and_valid / cell.rcnn.within_20deg) : "-"});
  cells.push_back({shown ? percent_text(cell.rcnn.error_below_3_expected) : "-"});
  cells.push_back({shown ? ratio_text(cell.rcnn.expected_over_real) : "-"});
  cells.push_back({percent_text(pose.verified)});
  cells.push_back({percent_text(pose.verified_wrong)});
  cells.push_back({percent_text(cell.never_valid_from_fifth)});
  cells.push_back({goal ? reached ? "yes" : "no" : "", mark(reached)});
  cells.push_back({missed.empty() ? "yes" : "no: " + missed, mark(missed.empty())});
  return cells;
}

}  // namespace

DataTable cell_table(const std::string& target, const CellResult& cell) {
  const PaperFigures paper = paper_figures(target, cell);
  std::vector<EstimatorErrors> estimators{
      {"RCNN, " + counted(cell.frames, "frame"), Mark::kRcnn, cell.rcnn, paper.rcnn},
      {"CNN, last frame alone", Mark::kCnn, cell.cnn, paper.cnn}};
  if (cell.baseline) estimators.push_back({"template matching", Mark::kNone, *cell.baseline, std::nullopt});
  return estimators_table(estimators, paper.sequences);
}

DataTable conditions_table(const std::vector<SubjectResult>& subjects, ConditionTables table) {
  DataTable made{condition_header(table), {}};
  for (const SubjectResult& subject : subjects) {
    if ((table & kOverviews) != 0) made.rows.push_back({{title_of(subject)}});
    for (const ResultRow& row : condition_rows(subject)) made.rows.push_back(condition_cells(row, table));
  }
  return made;
}

DataTable poses_table(const SubjectResult& subject) {
  std::vector<NamedPoses> poses;
  for (const CellResult& cell : subject.cells) poses.push_back({run_name(cell), cell.pose_first, cell.pose});
  return poses_table(poses);
}

std::string run_name(const CellResult& cell) {
  std::string name = to_string(cell.condition);
  for (const std::string& other : {differences_from_paper(cell), to_string(cell.disturbances)})
    if (!other.empty()) name += ", " + other;
  return name;
}

std::vector<const CellResult*> all_cells(const SubjectResult& subject) {
  std::vector<const CellResult*> all;
  for (const auto* cells : {&subject.cells, &subject.disturbed, &subject.sensor_runs})
    for (const CellResult& cell : *cells) all.push_back(&cell);
  return all;
}

DataTable accuracy_table(const SubjectResult& subject) {
  DataTable table{{"last frame", "sequences", "attitude, mean", "within 20°", "pose, mean within 20°",
                   "verified", "inside 95 %"},
                  {}};
  for (const CellResult* cell : all_cells(subject)) {
    table.rows.push_back({{run_name(*cell)},
                          {std::to_string(cell->rcnn.count)},
                          {degrees_text(cell->rcnn.mean_deg)},
                          {percent_text(cell->rcnn.within_20deg)},
                          {text_or_dash(cell->pose.mean_within_20_deg, degrees_text)},
                          {text_or_dash(cell->pose.verified, percent_text)},
                          {text_or_dash(cell->pose.inside_95, percent_text)}});
  }
  return table;
}

DataTable rare_events_table(const SubjectResult& subject) {
  DataTable table{{"last frame, 95 % bounds", "of"}, {}};
  for (const RareEventRow& row : rare_event_table()) table.header.emplace_back(row.name);
  for (const CellResult* cell : all_cells(subject)) {
    Cells line{{run_name(*cell)}, {std::to_string(cell->rare.of)}};
    for (std::size_t i = 0; i < cell->rare.counts.size(); ++i) {
      const bool is_known = cell->rare.has_poses || !rare_event_table()[i].of_pose;
      line.push_back({is_known ? count_text(cell->rare.counts[i], cell->rare.of) : "-"});
    }
    table.rows.push_back(line);
  }
  return table;
}

DataTable worst_sequences_table(const CellResult& cell) {
  DataTable table{{"sequence", "attitude off", "valid", "pose off", "verified", "range [m]", "rate [deg/s]"},
                  {}};
  for (const WorstSequence& one : cell.rare.worst) {
    table.rows.push_back({{std::to_string(one.sequence)},
                          {degrees_text(one.error_deg)},
                          {one.valid ? "yes" : "no"},
                          {text_or_dash(one.pose_deg, degrees_text)},
                          {cell.rare.has_poses ? one.pose_verified ? "yes" : "no" : "-"},
                          {fmt::format("{:.1f}", one.range_m)},
                          {fmt::format("{:.1f}", one.rate_deg_s)}});
  }
  return table;
}

DataTable frames_table(const SubjectResult& subject) {
  DataTable table{{"frame"}, {}};
  for (const CellResult& cell : subject.cells) table.header.push_back(to_string(cell.condition));
  for (std::size_t frame = 0; frame < subject.cells.front().by_frame.size(); ++frame) {
    Cells row{{std::to_string(frame + 1)}};
    for (const CellResult& cell : subject.cells)
      row.push_back({degrees_text(cell.by_frame[frame].rcnn.mean_deg)});
    table.rows.push_back(row);
  }
  return table;
}

DataTable curve_table(const std::string& at, const Curve& curve, double scale) {
  const SummaryFigure& mean = summary_figure(&ErrorSummary::mean_deg);
  const SummaryFigure& within_20deg = summary_figure(&ErrorSummary::within_20deg);
  DataTable table{{at, "sequences", "RCNN mean", within_20deg.heading, "CNN mean"}, {}};
  for (const CurvePoint& point : curve) {
    if (point.rcnn.count == 0) continue;
    table.rows.push_back({{fmt::format("{:g}", scale * point.at)},
                          {std::to_string(point.rcnn.count)},
                          figure_cell(mean, point.rcnn),
                          figure_cell(within_20deg, point.rcnn),
                          figure_cell(mean, point.cnn)});
  }
  return table;
}

DataTable histogram_table(const CellResult& cell) {
  const std::vector<double>& limits = histogram_limits_deg();
  DataTable table{{"error", "RCNN", "CNN", "templates"}, {}};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    table.rows.push_back(
        {{fmt::format("{:g}–{:g}°", i == 0 ? 0.0 : limits[i - 1], limits[i])},
         {percent_text(cell.rcnn_histogram[i])},
         {percent_text(cell.cnn_histogram[i])},
         {cell.baseline_histogram.empty() ? "-" : percent_text(cell.baseline_histogram[i])}});
  }
  return table;
}

DataTable confusion_table(const SubjectResult& subject) {
  DataTable table{{"condition"}, {}};
  for (const std::string& name : subject.cells.front().rcnn_confusion.names) table.header.push_back(name);
  for (const char* name : {"none of these", "blur", "CNN right", "CNN blur"}) table.header.emplace_back(name);
  for (const CellResult& cell : subject.cells) {
    const Confusion& rcnn = cell.rcnn_confusion;
    const Confusion& cnn = cell.cnn_confusion;
    Cells row{{to_string(cell.condition)}};
    for (const double share : rcnn.shares) row.push_back({percent_text(share)});
    row.push_back({percent_text(rcnn.none)});
    row.push_back({degrees_text(rcnn.blur_deg, rcnn.blur_standard_error_deg)});
    row.push_back({percent_text(cnn.shares.front())});
    row.push_back({degrees_text(cnn.blur_deg, cnn.blur_standard_error_deg)});
    table.rows.push_back(row);
  }
  return table;
}

DataTable reliability_table(const CellResult& cell) {
  DataTable table{{"expected", "actual, mean", "actual, median", "frames"}, {}};
  for (const ReliabilityBin& bin : cell.reliability) {
    table.rows.push_back({{degrees_text(bin.predicted_deg)},
                          {degrees_text(bin.real.mean_deg)},
                          {degrees_text(bin.real.median_deg)},
                          {std::to_string(bin.real.count)}});
  }
  return table;
}

DataTable detection_table(const SubjectResult& subject) {
  DataTable table{{"threshold", "wrong rejected", "right rejected", "wrong among the accepted"}, {}};
  for (const DetectionPoint& point : detection_of(subject)) {
    table.rows.push_back({{fmt::format("{:g}°", point.threshold_deg)},
                          {percent_text(point.detected())},
                          {percent_text(point.false_alarms())},
                          {fmt::format("{:.2f} %", 100.0 * point.wrong_among_kept())}});
  }
  return table;
}

DataTable disturbed_table(const SubjectResult& subject) {
  DataTable table{
      {"condition", "disturbed by", "mean within 20°", "within 20°", "wrong and valid", "right and valid",
       "bar", "met", "pose, mean within 20°", "pose within 20°", "verified, wrong"},
      {}};
  const auto share = [](const CellResult& cell, double value) {
    return TableCell{percent_text(value, cell.rcnn.count)};
  };
  for (const CellResult& cell : subject.disturbed) {
    const DisturbedRun* run = disturbed_run_of(cell);
    const std::string bar = run == nullptr ? std::string{} : text_of(run->bar);
    const bool met = run != nullptr && meets(run->bar, cell, cell_of(subject, cell.condition));
    Cells cells{{to_string(cell.condition)}, {to_string(cell.disturbances)}};
    cells.push_back(
        {degrees_text(cell.rcnn.mean_within_20_deg, cell.rcnn.mean_within_20_standard_error_deg)});
    cells.push_back(share(cell, cell.rcnn.within_20deg));
    cells.push_back(share(cell, cell.rcnn.wrong_and_valid));
    cells.push_back(share(cell, cell.rcnn.right_and_valid));
    cells.push_back({bar.empty() ? "-" : bar});
    cells.push_back(bar.empty() ? TableCell{""}
                                : TableCell{met ? "yes" : "no", met ? Mark::kMet : Mark::kMissed});
    const bool has_poses = cell.pose.known > 0.0;
    cells.push_back({has_poses ? pose_error_text(cell.pose.mean_within_20_deg) : "-"});
    cells.push_back({has_poses ? percent_text(cell.pose.within_20deg, cell.pose.count) : "-"});
    cells.push_back({has_poses ? percent_text(cell.pose.verified_wrong) : "-"});
    table.rows.push_back(cells);
  }
  return table;
}

DataTable goals_table(const SubjectResult& subject) {
  DataTable table{
      {"frames", "sequences", "network within 20°", "pose, mean within 20°", "pose within 20°", "goal",
       "wrong and valid", "valid of the right ones", "error below 3 expected", "expected over real",
       "verified", "verified, wrong", "never valid from the fifth frame", "goal met", "trust met"},
      {}};
  for (const auto* cells : {&subject.cells, &subject.sensor_runs}) {
    for (const CellResult& cell : *cells) {
      const std::optional<PoseGoal> goal = pose_goal(subject.target, cell);
      const bool counts = goal ? cell.pose.known > 0.0 : !show_the_target(cell.effects);
      if (counts) table.rows.push_back(goal_cells(cell, goal));
    }
  }
  return table;
}

DataTable checks_table(const SubjectResult& subject) {
  DataTable table{{"check", "value and limit", "met"}, {}};
  for (const Check& check : checks_of(subject)) {
    table.rows.push_back({{check.what},
                          {text_of(check)},
                          {check.holds() ? "yes" : "no", check.holds() ? Mark::kMet : Mark::kMissed}});
  }
  return table;
}

}  // namespace tumblesight::sim
