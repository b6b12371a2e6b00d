#include <fmt/format.h>

#include <algorithm>

#include "sim/report/colours.hpp"
#include "sim/report/error_figures.hpp"
#include "sim/report/page.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kErrorLabel = "mean angular error [deg]";

bool any_points(const LineChart& chart) {
  return std::any_of(chart.series.begin(), chart.series.end(),
                     [](const Series& s) { return s.points.size() > 1; });
}

std::string line_chart_or_nothing(const LineChart& chart) {
  return any_points(chart) ? line_chart(chart) : std::string{};
}

}  // namespace

std::string conditions_figure(const SubjectResult& subject) {
  if (subject.cells.size() < 2) return {};
  bool with_baseline = false;
  bool with_paper = false;
  for (const CellResult& cell : subject.cells) {
    with_baseline = with_baseline || cell.baseline.has_value();
    with_paper = with_paper || paper_figures(subject.target, cell).rcnn.has_value();
  }
  BarChart chart;
  chart.description = "Mean error of the last frame by condition and estimator";
  chart.x_label = "condition";
  chart.y_label = kErrorLabel;
  chart.series_names = {"RCNN", "CNN"};
  chart.series_colours = {kRcnnColour, kCnnColour};
  if (with_baseline) {
    chart.series_names.emplace_back("template matching");
    chart.series_colours.emplace_back(kBaselineColour);
  }
  if (with_paper) {
    chart.series_names.emplace_back("RCNN in the paper");
    chart.series_colours.emplace_back(kPaperColour);
  }
  for (const CellResult& cell : subject.cells) {
    const PaperFigures paper = paper_figures(subject.target, cell);
    BarGroup group{to_string(cell.condition), {cell.rcnn.mean_deg, cell.cnn.mean_deg}};
    if (with_baseline) group.values.push_back(cell.baseline ? cell.baseline->mean_deg : 0.0);
    if (with_paper) group.values.push_back(paper.rcnn ? paper.rcnn->mean_deg : 0.0);
    chart.groups.push_back(std::move(group));
  }
  return bar_chart(chart);
}

std::string frames_figure(const SubjectResult& subject) {
  LineChart chart;
  chart.description = "Mean error of the RCNN over the frame number, by condition";
  chart.x_label = fmt::format("frame (one every {:.1f} s)", kFramePeriod_s);
  chart.y_label = kErrorLabel;
  chart.x_low = 1.0;
  for (const CellResult& cell : subject.cells) {
    chart.x_high = std::max(chart.x_high, static_cast<double>(cell.frames));
    chart.series.push_back(mean_series(to_string(cell.condition), colour_of(cell.condition), cell.by_frame,
                                       Estimator::kRcnn, false));
  }
  if (!subject.cells.empty()) {
    chart.series.push_back(
        mean_series("CNN", kCnnColour, subject.cells.front().by_frame, Estimator::kCnn, false));
  }
  return line_chart_or_nothing(chart);
}

std::string range_figure(const CellResult& cell) {
  LineChart chart;
  chart.description = "Mean error of the last frame over the range";
  chart.x_label = "range [m], bins of 10 m";
  chart.y_label = kErrorLabel;
  chart.x_low = 20.0;
  chart.x_high = 100.0;
  chart.x_ticks = round_ticks(20.0, 100.0, 8);
  chart.series = {mean_series("RCNN", kRcnnColour, cell.by_range, Estimator::kRcnn, true),
                  mean_series("CNN", kCnnColour, cell.by_range, Estimator::kCnn, true)};
  return line_chart_or_nothing(chart);
}

std::string rate_figure(const SubjectResult& subject) {
  if (subject.cells.empty()) return {};
  LineChart chart;
  chart.description = "Mean error of the last frame over the rate";
  chart.x_label = "rate [deg/s], bins of 2.5 deg/s";
  chart.y_label = kErrorLabel;
  chart.x_high = 20.0;
  chart.x_ticks = {0.0, 2.5, 5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0};
  const Curve& components = subject.cells.front().by_rate;
  chart.series = {mean_series("RCNN, components drawn", kRcnnColour, components, Estimator::kRcnn, true)};
  if (subject.sweeps) {
    const Curve& norm = subject.sweeps->by_rate_norm;
    chart.series.push_back(mean_series("RCNN, norm drawn", "#3fa0a8", norm, Estimator::kRcnn, true));
    chart.series.push_back(mean_series("CNN, norm drawn", kCnnColour, norm, Estimator::kCnn, true));
  } else {
    chart.series.push_back(mean_series("CNN", kCnnColour, components, Estimator::kCnn, true));
  }
  return line_chart_or_nothing(chart);
}

std::string hidden_share_figure(const Sweeps& sweeps) {
  Curve percent = sweeps.by_hidden_share;
  for (CurvePoint& point : percent) point.at *= 100.0;
  LineChart chart;
  chart.description = "Mean error of the last frame over the share of the target that is hidden";
  chart.x_label = "hidden share of the target's returns [%]";
  chart.y_label = kErrorLabel;
  chart.x_high = 50.0;
  chart.x_ticks = round_ticks(0.0, 50.0, 10);
  chart.series = {mean_series("RCNN", kRcnnColour, percent, Estimator::kRcnn, true),
                  mean_series("CNN", kCnnColour, percent, Estimator::kCnn, true)};
  return line_chart_or_nothing(chart);
}

std::string long_run_figure(const Sweeps& sweeps) {
  LineChart chart;
  chart.description = "Mean error of the RCNN by frame in a long run";
  chart.x_label = "frame";
  chart.y_label = kErrorLabel;
  chart.x_low = 0.0;
  chart.x_high = static_cast<double>(sweeps.long_run.size());
  chart.x_ticks = round_ticks(0.0, chart.x_high, 10);
  chart.series = {mean_series("RCNN", kRcnnColour, sweeps.long_run, Estimator::kRcnn, false)};
  if (sweeps.long_run.size() >= kFramesPerSequence) {
    const double tenth_deg = sweeps.long_run[kFramesPerSequence - 1].rcnn.mean_deg;
    chart.series.push_back({"10th frame", "#8a9099", "5 4", {{0.0, tenth_deg}, {chart.x_high, tenth_deg}}});
  }
  return line_chart_or_nothing(chart);
}

}  // namespace tumblesight::sim
