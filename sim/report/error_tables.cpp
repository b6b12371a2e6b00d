#include "sim/report/error_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tumblesight::sim {
namespace {

using Cells = std::vector<TableCell>;

constexpr std::size_t kMaxFrameColumns = 10;

Cells estimator_cells(const EstimatorErrors& errors) {
  Cells cells{{errors.name, errors.mark}};
  for (const SummaryFigure& figure : summary_figures()) cells.push_back(figure_cell(figure, errors.summary));
  cells.push_back({std::to_string(errors.summary.count)});
  return cells;
}

Cells paper_cells(const PaperFigure& paper, std::uint32_t sequences) {
  Cells cells{{"in the paper", Mark::kPaper}};
  for (const SummaryFigure& figure : summary_figures()) cells.push_back(paper_cell(figure, paper));
  cells.push_back({std::to_string(sequences), Mark::kPaper});
  return cells;
}

}  // namespace

DataTable estimators_table(const std::vector<EstimatorErrors>& estimators, std::uint32_t paper_sequences) {
  DataTable table{{"error of the last frame"}, {}};
  for (const SummaryFigure& figure : summary_figures()) table.header.emplace_back(figure.heading);
  table.header.emplace_back("sequences");
  for (const EstimatorErrors& errors : estimators) {
    table.rows.push_back(estimator_cells(errors));
    if (errors.paper) table.rows.push_back(paper_cells(*errors.paper, paper_sequences));
  }
  return table;
}

DataTable poses_table(const std::vector<NamedPoses>& poses) {
  DataTable table{{"registered pose"}, {}};
  for (const PoseFigure& figure : pose_figures())
    if (figure.of_first_frame) table.header.push_back(std::string("first frame, ") + figure.heading);
  for (const PoseFigure& figure : pose_figures())
    if (figure.heading != nullptr) table.header.emplace_back(figure.heading);
  for (const auto& [name, first, last] : poses) {
    if (!(last.known > 0.0)) continue;
    Cells cells{{name}};
    for (const PoseFigure& figure : pose_figures())
      if (figure.of_first_frame) cells.push_back(pose_cell(figure, first));
    for (const PoseFigure& figure : pose_figures())
      if (figure.heading != nullptr) cells.push_back(pose_cell(figure, last));
    table.rows.push_back(cells);
  }
  return table;
}

DataTable by_frame_table(const Curve& by_frame) {
  const std::size_t columns = std::min<std::size_t>(by_frame.size(), kMaxFrameColumns);
  DataTable table{{"error by frame [deg]"},
                  {{{"RCNN mean"}}, {{"RCNN median"}}, {{"CNN mean"}}, {{"CNN median"}}}};
  for (std::size_t column = 0; column < columns; ++column) {
    const CurvePoint& errors = by_frame[columns < 2 ? 0 : column * (by_frame.size() - 1) / (columns - 1)];
    table.header.push_back(fmt::format("{:g}", errors.at));
    const double figures[] = {errors.rcnn.mean_deg, errors.rcnn.median_deg, errors.cnn.mean_deg,
                              errors.cnn.median_deg};
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      table.rows[i].push_back({errors.rcnn.count == 0 ? "-" : fmt::format("{:.1f}", figures[i])});
    }
  }
  return table;
}

}  // namespace tumblesight::sim
