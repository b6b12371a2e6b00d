#include "sim/training/training_log.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "sim/host/write_file.hpp"
#include "sim/report/charts.hpp"
#include "sim/report/colours.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kHeader =
    "stage,iteration,samples,seconds,learning_rate,loss,best_hypothesis_deg,mean_deg,median_deg,within_20deg";

std::string to_csv(const TrainingPoint& p) {
  char line[256];
  std::snprintf(line, sizeof line, "%s,%lld,%lld,%.1f,%.3e,%.5f,%.3f,%.3f,%.3f,%.4f", p.stage.c_str(),
                static_cast<long long>(p.iteration), static_cast<long long>(p.samples), p.seconds,
                p.learning_rate, p.loss, p.best_deg, p.mean_deg, p.median_deg, p.within_20deg);
  return line;
}

bool from_csv(std::string line, TrainingPoint& p) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream in(line);
  return static_cast<bool>(in >> p.stage >> p.iteration >> p.samples >> p.seconds >> p.learning_rate >>
                           p.loss >> p.best_deg >> p.mean_deg >> p.median_deg >> p.within_20deg);
}

double largest_seconds(const std::vector<TrainingPoint>& points, const char* stage) {
  double largest = 0.0;
  for (const TrainingPoint& point : points) {
    if (point.stage == stage) largest = std::max(largest, point.seconds);
  }
  return largest;
}

// Both stages on one axis of time: the RCNN's begins where the CNN's ends.
std::string error_curve(const std::vector<TrainingPoint>& points) {
  const double cnn_min = largest_seconds(points, "cnn") / 60.0;
  Series cnn{"CNN, single frame", kCnnColour, "", {}};
  Series best{"its best hypothesis", "#e8b48c", "", {}};
  Series rcnn{"RCNN, last frame", kRcnnColour, "", {}};
  LineChart chart;
  for (const TrainingPoint& point : points) {
    const bool single_frame = point.stage == "cnn";
    const double minutes = point.seconds / 60.0 + (single_frame ? 0.0 : cnn_min);
    chart.x_high = std::max(chart.x_high, minutes);
    (single_frame ? cnn : rcnn).points.push_back({minutes, point.mean_deg});
    if (single_frame) best.points.push_back({minutes, point.best_deg});
  }
  chart.description = "Mean validation error over the training time";
  chart.x_label = "training time [min]";
  chart.y_label = "mean validation error [deg]";
  chart.y_low = 1.0;
  chart.y_high = 180.0;
  chart.logarithmic_y = true;
  chart.x_ticks = round_ticks(0.0, chart.x_high, 6);
  chart.x_high = chart.x_ticks.back();
  for (Series* series : {&cnn, &best, &rcnn}) {
    if (!series->points.empty()) chart.series.push_back(*series);
  }
  return standalone_svg(line_chart(chart));
}

}  // namespace

std::vector<TrainingPoint> read_training_log(const std::string& folder) {
  std::vector<TrainingPoint> points;
  std::ifstream in(folder + "/log.csv");
  TrainingPoint point;
  for (std::string line; std::getline(in, line);)
    if (from_csv(line, point)) points.push_back(point);
  return points;
}

TrainingLog::TrainingLog(const std::string& folder, const std::string& stage, std::int64_t last_iteration)
    : folder_(folder) {
  for (const TrainingPoint& point : read_training_log(folder)) {
    if (point.stage != stage || point.iteration <= last_iteration) points_.push_back(point);
  }
  std::string text = std::string(kHeader) + '\n';
  for (const TrainingPoint& p : points_) text += to_csv(p) + '\n';
  write_file(folder + "/log.csv", text);
}

void TrainingLog::add(const TrainingPoint& point) {
  points_.push_back(point);
  append_to_file(folder_ + "/log.csv", to_csv(point) + '\n');
  write_file(folder_ + "/curve.svg", error_curve(points_));
}

}  // namespace tumblesight::sim
