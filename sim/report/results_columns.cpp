#include "sim/report/results_columns.hpp"

#include <fmt/format.h>

#include <cmath>

#include "sim/evaluation/pose_goals.hpp"
#include "sim/evaluation/statistics.hpp"

namespace tumblesight::sim {
namespace {

// Quoted where a comma, a quotation mark or a line break would end the field.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// Figures of poses, in the lines of the RCNN, from whose attitudes the registration starts.
void add_pose_columns(std::vector<CsvColumn>& columns, const std::string& prefix,
                      PoseSummary CellResult::*poses) {
  for (const PoseFigure& figure : pose_figures()) {
    columns.push_back({prefix + figure.key,
                       [&figure, poses](const EstimatorRow& row) {
                         const PoseSummary& summary = row.cell.*poses;
                         const double value = summary.*figure.value;
                         const bool none = &row.summary != &row.cell.rcnn || !(summary.known > 0.0);
                         return none || std::isnan(value) ? std::string{}
                                                          : fmt::format("{:.{}f}", value, figure.decimals);
                       },
                       [](const EstimatorRow& row) { return row.cell.pose.known > 0.0; }});
  }
}

std::vector<CsvColumn> make_csv_columns() {
  using Row = EstimatorRow;
  std::vector<CsvColumn> columns{
      {"target", [](const Row& row) { return csv_text(row.subject.target); }},
      {"mesh", [](const Row& row) { return csv_text(row.subject.mesh); }},
      {"model", [](const Row& row) { return csv_text(row.subject.model); }},
      {"model_crc32", [](const Row& row) { return fmt::format("{:08x}", row.subject.model_crc32); }},
      {"variant", [](const Row& row) { return csv_text(row.subject.variant); },
       [](const Row& row) { return !row.subject.variant.empty(); }},
      {"condition", [](const Row& row) { return to_string(row.cell.condition); }},
      {"frames", [](const Row& row) { return std::to_string(row.cell.frames); }},
      {"seed", [](const Row& row) { return std::to_string(row.results.seed); }},
      {"estimator", [](const Row& row) { return std::string(row.estimator); }},
      {"sequences", [](const Row& row) { return std::to_string(row.summary.count); }}};
  const auto number = [](const Row& row, double value, int decimals) {
    return row.summary.count == 0 || std::isnan(value) ? std::string{}
                                                       : fmt::format("{:.{}f}", value, decimals);
  };
  for (const SummaryFigure& figure : summary_figures()) {
    columns.push_back({figure.key, [&figure, number](const Row& row) {
                         return number(row, row.summary.*figure.value, figure.decimals);
                       }});
    if (figure.error_key == nullptr) continue;
    columns.push_back({figure.error_key, [&figure, number](const Row& row) {
                         return number(row, figure.error(row.summary), figure.decimals);
                       }});
  }
  for (const SummaryFigure& figure : summary_figures()) {
    if (figure.paper == nullptr) continue;
    columns.push_back({std::string("paper_") + figure.key, [&figure](const Row& row) {
                         return row.paper ? fmt::format("{}", (*row.paper).*figure.paper) : std::string{};
                       }});
  }
  columns.push_back(
      {"disturbances", [](const Row& row) { return csv_text(to_string(row.cell.disturbances)); }});
  columns.push_back({"effect", [](const Row& row) { return csv_text(to_string(row.cell.effects)); },
                     [](const Row& row) { return !to_string(row.cell.effects).empty(); }});
  columns.push_back({"sensor", [](const Row& row) { return csv_text(to_string(row.cell.sensor)); },
                     [](const Row& row) { return !row.cell.sensor.is_the_papers(); }});
  columns.push_back({"ranges_m",
                     [](const Row& row) {
                       const RangeLimits& ranges = row.cell.ranges;
                       return fmt::format("{} to {}", ranges.nearest_m, ranges.farthest_m);
                     },
                     [](const Row& row) { return !row.cell.ranges.are_the_papers(); }});
  columns.push_back({"symmetry", [](const Row& row) { return csv_text(to_string(row.cell.symmetry)); },
                     [](const Row& row) { return !row.cell.symmetry.is_none(); }});
  add_pose_columns(columns, "pose_", &CellResult::pose);
  add_pose_columns(columns, "pose_first_", &CellResult::pose_first);
  return columns;
}

const ErrorSummary* summary_of(const CellResult& cell, Estimator estimator) {
  if (estimator == Estimator::kRcnn) return &cell.rcnn;
  if (estimator == Estimator::kCnn) return &cell.cnn;
  return cell.baseline ? &*cell.baseline : nullptr;
}

// The figures of one estimator. The heading of those in degrees names the estimator; the shares stand next to
// them.
void add_figures(std::vector<ConditionColumn>& columns, const char* name, Estimator estimator,
                 const std::function<ConditionTables(const SummaryFigure&)>& tables_of) {
  for (const SummaryFigure& figure : summary_figures()) {
    const ConditionTables tables = tables_of(figure);
    if (tables == 0) continue;
    const Mark mark = estimator == Estimator::kRcnn && figure.paper != nullptr ? Mark::kRcnn : Mark::kNone;
    columns.push_back({tables,
                       figure.in_degrees ? fmt::format("{} {}", name, figure.heading) : figure.heading,
                       [&figure, estimator, mark](const ResultRow& row) {
                         const ErrorSummary* summary = summary_of(row.cell, estimator);
                         return summary == nullptr ? TableCell{"-"} : figure_cell(figure, *summary, mark);
                       }});
  }
}

// What the registered pose of this row has to reach.
TableCell pose_goal_cell(const ResultRow& row) {
  const std::optional<PoseGoal> goal = pose_goal(row.subject.target, row.cell);
  if (!goal || !(row.cell.pose.known > 0.0)) return {"-"};
  return {text_of(*goal), meets(row.cell.pose, *goal) ? Mark::kMet : Mark::kMissed};
}

std::vector<ConditionColumn> make_condition_columns() {
  using Row = ResultRow;
  constexpr ConditionTables kOthers = kOtherEstimatorsTable;
  std::vector<ConditionColumn> columns{
      {kOthers, "spacecraft, mesh", [](const Row& row) -> TableCell { return {title_of(row.subject)}; }},
      {~0U, "condition",
       [](const Row& row) -> TableCell {
         const std::string other = differences_from_paper(row.cell);
         return {to_string(row.cell.condition) + (other.empty() ? "" : ", ") + other};
       }},
      {kAccuracyTable, "sequences",
       [](const Row& row) -> TableCell { return {std::to_string(row.cell.sequences)}; }}};
  add_figures(columns, "RCNN", Estimator::kRcnn, [](const SummaryFigure& figure) {
    return kAccuracyTable | (figure.paper != nullptr ? kOverviews : 0U);
  });
  columns.push_back({kOverviews | kAccuracyTable, "paper",
                     [](const Row& row) -> TableCell { return {paper_text(row.paper.rcnn)}; }});
  columns.push_back({kOverviews, "goal of the pose", pose_goal_cell});
  const auto others = [](const SummaryFigure& figure) {
    if (figure.paper == nullptr) return 0U;
    return kOthers | kPageOverview | (figure.value == &ErrorSummary::mean_deg ? kTerminalOverview : 0U);
  };
  add_figures(columns, "CNN", Estimator::kCnn, others);
  columns.push_back(
      {kOthers, "CNN in the paper", [](const Row& row) -> TableCell { return {paper_text(row.paper.cnn)}; }});
  add_figures(columns, "templates", Estimator::kBaseline, others);
  columns.push_back({kOthers, "templates on sequences", [](const Row& row) -> TableCell {
                       return {row.cell.baseline ? std::to_string(row.cell.baseline->count) : "-"};
                     }});
  columns.push_back({kOthers, "step ms",
                     [](const Row& row) -> TableCell { return {fmt::format("{:.2f}", row.cell.step_ms)}; }});
  columns.push_back({kOthers, "templates ms", [](const Row& row) -> TableCell {
                       return {row.cell.baseline ? fmt::format("{:.0f}", row.cell.baseline_ms) : "-"};
                     }});
  return columns;
}

}  // namespace

std::vector<EstimatorRow> estimator_rows(const Results& results) {
  std::vector<EstimatorRow> rows;
  for (const SubjectResult& subject : results.subjects) {
    for (const CellResult& cell : subject.cells) {
      const PaperFigures paper = paper_figures(subject.target, cell);
      rows.push_back({results, subject, cell, "rcnn", cell.rcnn, paper.rcnn});
      rows.push_back({results, subject, cell, "cnn", cell.cnn, paper.cnn});
      if (cell.baseline) rows.push_back({results, subject, cell, "baseline", *cell.baseline, std::nullopt});
    }
    for (const auto* further : {&subject.disturbed, &subject.sensor_runs}) {
      for (const CellResult& cell : *further) {
        rows.push_back({results, subject, cell, "rcnn", cell.rcnn, std::nullopt});
        rows.push_back({results, subject, cell, "cnn", cell.cnn, std::nullopt});
      }
    }
  }
  return rows;
}

const std::vector<CsvColumn>& csv_columns() {
  static const std::vector<CsvColumn> columns = make_csv_columns();
  return columns;
}

std::vector<ResultRow> condition_rows(const SubjectResult& subject) {
  std::vector<ResultRow> rows;
  for (const CellResult& cell : subject.cells) {
    rows.push_back({subject, cell, paper_figures(subject.target, cell)});
  }
  return rows;
}

const std::vector<ConditionColumn>& condition_columns() {
  static const std::vector<ConditionColumn> columns = make_condition_columns();
  return columns;
}

}  // namespace tumblesight::sim
