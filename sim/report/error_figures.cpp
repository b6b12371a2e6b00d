#include "sim/report/error_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/evaluation/statistics.hpp"
#include "sim/report/colours.hpp"

namespace tumblesight::sim {

Series mean_series(const std::string& name, const std::string& colour, const Curve& curve,
                   Estimator estimator, bool bars) {
  Series series{name, colour, estimator == Estimator::kCnn ? "6 4" : "", {}};
  for (const CurvePoint& point : curve) {
    const ErrorSummary& summary = estimator == Estimator::kCnn ? point.cnn : point.rcnn;
    if (summary.count == 0) continue;
    series.points.push_back({point.at, summary.mean_deg});
    if (bars) series.error_bars.push_back(summary.mean_standard_error_deg);
  }
  return series;
}

std::string histogram_figure(const std::vector<double>& rcnn, const std::vector<double>& cnn,
                             const std::vector<double>& baseline) {
  BarChart chart;
  chart.description = "Distribution of the last frame's angular error";
  chart.x_label = "angular error of the last frame [deg]";
  chart.y_label = "share of the sequences [%]";
  std::vector<const std::vector<double>*> shown;
  const auto show = [&](const std::vector<double>& shares, const char* name, const char* colour) {
    if (shares.empty()) return;
    shown.push_back(&shares);
    chart.series_names.emplace_back(name);
    chart.series_colours.emplace_back(colour);
  };
  show(rcnn, "RCNN", kRcnnColour);
  show(cnn, "CNN", kCnnColour);
  show(baseline, "template matching", kBaselineColour);
  if (shown.empty()) return {};
  const std::vector<double>& limits_deg = histogram_limits_deg();
  for (std::size_t i = 0; i < limits_deg.size(); ++i) {
    BarGroup group{fmt::format("{:g}–{:g}", i == 0 ? 0.0 : limits_deg[i - 1], limits_deg[i]), {}};
    for (const std::vector<double>* shares : shown) group.values.push_back(100.0 * (*shares)[i]);
    chart.groups.push_back(std::move(group));
  }
  return bar_chart(chart);
}

std::string confusion_figure(const std::vector<Named<Confusion>>& rows) {
  if (rows.empty()) return {};
  MatrixChart chart;
  chart.description = "Share of the estimates near each nearly symmetric attitude";
  chart.columns = rows.front().figures.names;
  chart.columns.emplace_back("none of these");
  chart.remark_heading = "blur";
  for (const auto& [name, colour, confusion] : rows) {
    MatrixChart::Row row{name, confusion.shares, degrees_text(confusion.blur_deg)};
    row.shares.push_back(confusion.none);
    chart.rows.push_back(std::move(row));
  }
  return matrix_chart(chart);
}

std::string reliability_figure(const std::vector<Named<std::vector<ReliabilityBin>>>& lines) {
  AgreementChart chart;
  chart.description = "Mean actual error over the expected error";
  chart.x_label = "expected error [deg]";
  chart.y_label = "actual error, mean [deg]";
  chart.low = 0.3;
  for (const auto& [name, colour, bins] : lines) {
    Series series{name, colour, "", {}};
    for (const ReliabilityBin& bin : bins) series.points.push_back({bin.predicted_deg, bin.real.mean_deg});
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  return chart.series.empty() ? std::string{} : agreement_chart(chart);
}

std::string detection_figure(const std::vector<DetectionPoint>& points) {
  if (points.empty() || points.front().wrong == 0) return {};
  LineChart chart;
  chart.description =
      "Share of the wrong estimates that are rejected over the share of right estimates rejected";
  chart.x_label = "right estimates rejected [%]";
  chart.y_label = "wrong estimates rejected [%]";
  chart.x_high = 100.0;
  chart.y_high = 100.0;
  chart.x_ticks = round_ticks(0.0, 100.0, 10);
  Series series{"RCNN, threshold on the expected error", kRcnnColour, "", {{100.0, 100.0}}};
  for (const DetectionPoint& point : points) {
    series.points.push_back({100.0 * point.false_alarms(), 100.0 * point.detected()});
  }
  series.points.push_back({0.0, 0.0});
  series.error_bars.assign(series.points.size(), 0.0);  // marks at the points
  chart.series = {series, {"guessing", "#8a9099", "5 4", {{0.0, 0.0}, {100.0, 100.0}}}};
  return line_chart(chart);
}

}  // namespace tumblesight::sim
