#include "sim/cli/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/evaluation/table.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostColumns = 10;

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

void add_summary(Table& table, const std::string& name, const ErrorSummary& summary) {
  if (summary.count == 0) {
    table.row({name, "-", "-", "-", "-"});
    return;
  }
  table.row({name, fmt::format("{:.2f}°", summary.mean_deg), fmt::format("{:.2f}°", summary.median_deg),
             percent(summary.within_20deg), percent(summary.within_5deg)});
}

void add_paper(Table& table, const std::optional<PaperFigure>& figure) {
  if (!figure) return;
  table.row({"  in the paper", fmt::format("{:.2f}°", figure->mean_deg), "-",
             fmt::format("{:.0f} %", 100.0 * figure->within_20deg), "-"});
}

}  // namespace

nlohmann::ordered_json summary_json(const ErrorSummary& summary) {
  nlohmann::ordered_json json{{"mean_deg", summary.mean_deg},
                              {"median_deg", summary.median_deg},
                              {"within_20deg", summary.within_20deg},
                              {"within_5deg", summary.within_5deg}};
  if (summary.count == 0) {
    for (auto& value : json) value = nullptr;
  }
  return json;
}

std::string headline_table(const std::vector<FrameResult>& results, std::uint32_t frames,
                           const PaperFigures& paper) {
  Table table({"last frame", "mean", "median", "within 20°", "within 5°"});
  add_summary(table, fmt::format("RCNN, {} frames", frames),
              summarise(last_frame_errors_deg(results, frames, Estimator::kRcnn)));
  add_paper(table, paper.rcnn);
  add_summary(table, "CNN, the last frame alone",
              summarise(last_frame_errors_deg(results, frames, Estimator::kCnn)));
  add_paper(table, paper.cnn);
  return table.text();
}

std::string by_frame_table(const std::vector<FrameResult>& results, std::uint32_t frames) {
  const std::vector<FrameErrors> all = errors_by_frame(results, frames);
  const std::size_t columns = std::min<std::size_t>(all.size(), kMostColumns);
  std::vector<std::string> header{"error by frame [deg]"};
  std::vector<std::vector<std::string>> rows{{"RCNN mean"}, {"RCNN median"}, {"CNN mean"}, {"CNN median"}};
  for (std::size_t column = 0; column < columns; ++column) {
    const FrameErrors& errors = all[columns < 2 ? 0 : column * (all.size() - 1) / (columns - 1)];
    header.push_back(fmt::format("{}", errors.frame + 1));
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

}  // namespace tumblesight::sim
