#include "sim/report/results_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/evaluation/statistics.hpp"
#include "sim/terminal/table.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostColumns = 10;

void add_summary(Table& table, const std::string& name, const ErrorSummary& summary) {
  if (summary.count == 0) {
    table.row({name, "-", "-", "-", "-"});
    return;
  }
  table.row({name, mean_text(summary), degrees_text(summary.median_deg), within_20deg_text(summary),
             percent_text(summary.within_5deg, summary.count)});
}

void add_paper(Table& table, const std::string& name, const std::optional<PaperFigure>& figure) {
  if (!figure) return;
  table.row({name, degrees_text(figure->mean_deg), "-", fmt::format("{:.3g} %", 100.0 * figure->within_20deg),
             "-"});
}

}  // namespace

std::string mean_text(const ErrorSummary& summary) {
  if (summary.count == 0) return "-";
  if (summary.count == 1) return degrees_text(summary.mean_deg);
  return degrees_text(summary.mean_deg, summary.mean_standard_error_deg);
}

std::string within_20deg_text(const ErrorSummary& summary) {
  return summary.count == 0 ? "-" : percent_text(summary.within_20deg, summary.count);
}

std::string figure_text(const std::optional<PaperFigure>& figure) {
  if (!figure) return "-";
  return fmt::format("{:.2f}°, {:.3g} %", figure->mean_deg, 100.0 * figure->within_20deg);
}

std::string cell_table(const ErrorSummary& rcnn, const ErrorSummary& cnn,
                       const std::optional<ErrorSummary>& baseline, std::uint32_t frames,
                       const PaperFigures& paper) {
  Table table({"last frame", "mean", "median", "within 20°", "within 5°"});
  add_summary(table, fmt::format("RCNN, {} frames", frames), rcnn);
  add_paper(table, "  in the paper", paper.rcnn);
  add_summary(table, "CNN, the last frame alone", cnn);
  add_paper(table, "  in the paper", paper.cnn);
  if (baseline)
    add_summary(table, fmt::format("template matching, {} sequences", baseline->count), *baseline);
  return table.text();
}

std::string by_frame_table(const Curve& by_frame) {
  const std::size_t columns = std::min<std::size_t>(by_frame.size(), kMostColumns);
  std::vector<std::string> header{"error by frame [deg]"};
  std::vector<std::vector<std::string>> rows{{"RCNN mean"}, {"RCNN median"}, {"CNN mean"}, {"CNN median"}};
  for (std::size_t column = 0; column < columns; ++column) {
    const CurvePoint& errors = by_frame[columns < 2 ? 0 : column * (by_frame.size() - 1) / (columns - 1)];
    header.push_back(fmt::format("{:g}", errors.at));
    const double figures[] = {errors.rcnn.mean_deg, errors.rcnn.median_deg, errors.cnn.mean_deg,
                              errors.cnn.median_deg};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].push_back(errors.rcnn.count == 0 ? "-" : fmt::format("{:.1f}", figures[i]));
    }
  }
  Table table(header);
  for (auto& row : rows) table.row(row);
  return table.text();
}

std::string curve_table(const std::string& at, const Curve& curve) {
  Table table({at, "sequences", "RCNN", "within 20°", "CNN"});
  for (const CurvePoint& point : curve) {
    if (point.rcnn.count == 0) continue;
    table.row({fmt::format("{:g}", point.at), fmt::format("{}", point.rcnn.count), mean_text(point.rcnn),
               within_20deg_text(point.rcnn), mean_text(point.cnn)});
  }
  return table.text();
}

std::string overview_table(const Results& results) {
  Table table({"", "RCNN", "within 20°", "paper", "goal", "CNN", "template matching"});
  bool first = true;
  for (const SubjectResult& subject : results.subjects) {
    if (!first) table.rule();
    first = false;
    table.row({title_of(subject)});
    for (const CellResult& cell : subject.cells) {
      const PaperFigures paper = paper_figures(subject.target, cell.condition);
      table.row({"  " + to_string(cell.condition), mean_text(cell.rcnn), within_20deg_text(cell.rcnn),
                 figure_text(paper.rcnn), figure_text(paper.goal), mean_text(cell.cnn),
                 cell.baseline ? mean_text(*cell.baseline) : "-"});
    }
  }
  return table.text();
}

}  // namespace tumblesight::sim
