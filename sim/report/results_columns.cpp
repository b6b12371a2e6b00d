#include "sim/report/results_columns.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "sim/evaluation/pose_goals.hpp"
#include "sim/evaluation/statistics.hpp"

namespace tumblesight::sim {
namespace {

double mean_error(const ErrorSummary& summary) {
  return summary.mean_standard_error_deg;
}

// The error of a single sequence cannot be known.
std::string mean_text(const ErrorSummary& summary) {
  if (summary.count == 1) return degrees_text(summary.mean_deg);
  return degrees_text(summary.mean_deg, summary.mean_standard_error_deg);
}

// In tables the mean of all and the two shares of the same count carry the standard errors.
template <double ErrorSummary::*value>
std::string short_degrees_text(const ErrorSummary& summary) {
  return degrees_text(summary.*value);
}

template <double ErrorSummary::*share>
std::string short_share_text(const ErrorSummary& summary) {
  return percent_text(summary.*share);
}

double mean_within_20_error(const ErrorSummary& summary) {
  return summary.mean_within_20_standard_error_deg;
}

std::string median_text(const ErrorSummary& summary) {
  return degrees_text(summary.median_deg);
}

template <double ErrorSummary::*share>
double share_error(const ErrorSummary& summary) {
  return share_standard_error(summary.*share, summary.count);
}

template <double ErrorSummary::*share>
std::string share_text(const ErrorSummary& summary) {
  return percent_text(summary.*share, summary.count);
}

std::string paper_degrees(double deg) {
  return degrees_text(deg);
}

std::string paper_percent(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

// Quoted where a comma, a quotation mark or a line break would end the field.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string millimetres_text(double metres) {
  return fmt::format("{:.1f} mm", 1e3 * metres);
}

std::string rate_text(double deg_s) {
  return fmt::format("{:.3f}°/s", deg_s);
}

std::string velocity_text(double m_s) {
  return fmt::format("{:.1f} mm/s", 1e3 * m_s);
}

std::string share_of_poses_text(double share) {
  return percent_text(share);
}

// A pose is some ten times as sharp as the network's attitude.
std::string pose_degrees_text(double deg) {
  return fmt::format("{:.3f}°", deg);
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

const std::vector<SummaryFigure>& summary_figures() {
  static const std::vector<SummaryFigure> figures{
      {"mean_deg", "mean_standard_error_deg", true, "mean", 4, &ErrorSummary::mean_deg, mean_error, mean_text,
       &PaperFigure::mean_deg, paper_degrees},
      {"median_deg", nullptr, true, "median", 4, &ErrorSummary::median_deg, nullptr, median_text, nullptr,
       nullptr},
      {"within_20deg", "within_20deg_standard_error", false, "within 20°", 5, &ErrorSummary::within_20deg,
       share_error<&ErrorSummary::within_20deg>, share_text<&ErrorSummary::within_20deg>,
       &PaperFigure::within_20deg, paper_percent},
      {"within_5deg", "within_5deg_standard_error", false, "within 5°", 5, &ErrorSummary::within_5deg,
       share_error<&ErrorSummary::within_5deg>, share_text<&ErrorSummary::within_5deg>, nullptr, nullptr},
      {"mean_within_20_deg", "mean_within_20_standard_error_deg", true, "mean within 20°", 4,
       &ErrorSummary::mean_within_20_deg, mean_within_20_error,
       short_degrees_text<&ErrorSummary::mean_within_20_deg>, nullptr, nullptr},
      {"wrong_and_valid", "wrong_and_valid_standard_error", false, "wrong, valid", 5,
       &ErrorSummary::wrong_and_valid, share_error<&ErrorSummary::wrong_and_valid>,
       short_share_text<&ErrorSummary::wrong_and_valid>, nullptr, nullptr},
      {"right_and_valid", "right_and_valid_standard_error", false, "right, valid", 5,
       &ErrorSummary::right_and_valid, share_error<&ErrorSummary::right_and_valid>,
       short_share_text<&ErrorSummary::right_and_valid>, nullptr, nullptr}};
  return figures;
}

const SummaryFigure& summary_figure(double ErrorSummary::*value) {
  for (const SummaryFigure& figure : summary_figures()) {
    if (figure.value == value) return figure;
  }
  throw std::out_of_range("an error figure that is not in summary_figures()");
}

const std::vector<PoseFigure>& pose_figures() {
  static const std::vector<PoseFigure> figures{
      {"mean_deg", nullptr, false, 4, &PoseSummary::mean_deg, pose_degrees_text},
      {"mean_within_20_deg", "mean within 20°", true, 4, &PoseSummary::mean_within_20_deg, pose_degrees_text},
      {"median_deg", "median", false, 4, &PoseSummary::median_deg, pose_degrees_text},
      {"within_20deg", "within 20°", true, 5, &PoseSummary::within_20deg, share_of_poses_text},
      {"across_m", "across", false, 5, &PoseSummary::across_m, millimetres_text},
      {"along_m", "along", false, 5, &PoseSummary::along_m, millimetres_text},
      {"rate_deg_s", "rate", false, 4, &PoseSummary::rate_deg_s, rate_text},
      {"velocity_m_s", "velocity", false, 5, &PoseSummary::velocity_m_s, velocity_text},
      {"verified", "verified", false, 5, &PoseSummary::verified, share_of_poses_text},
      {"verified_wrong", "verified, wrong", false, 5, &PoseSummary::verified_wrong, share_of_poses_text},
      {"inside_95", "inside 95 %", false, 5, &PoseSummary::inside_95, share_of_poses_text}};
  return figures;
}

TableCell pose_cell(const PoseFigure& figure, const PoseSummary& summary) {
  const double value = summary.*figure.value;
  if (!(summary.known > 0.0) || std::isnan(value)) return {"-"};
  return {figure.text(value)};
}

TableCell figure_cell(const SummaryFigure& figure, const ErrorSummary& summary, Mark mark) {
  if (summary.count == 0 || std::isnan(summary.*figure.value)) return {"-"};
  return {figure.text(summary), mark};
}

TableCell paper_cell(const SummaryFigure& figure, const PaperFigure& paper) {
  if (figure.paper == nullptr) return {"-"};
  return {figure.paper_text(paper.*figure.paper), Mark::kPaper};
}

std::string paper_text(const std::optional<PaperFigure>& figure) {
  if (!figure) return "-";
  std::string text;
  for (const SummaryFigure& column : summary_figures()) {
    if (column.paper != nullptr) text += (text.empty() ? "" : ", ") + paper_cell(column, *figure).text;
  }
  return text;
}

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
