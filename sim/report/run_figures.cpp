#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "sim/evaluation/curves.hpp"
#include "sim/evaluation/metrics.hpp"
#include "sim/report/charts.hpp"
#include "sim/report/colours.hpp"
#include "sim/report/error_figures.hpp"
#include "sim/report/page.hpp"
#include "sim/report/picture.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::array<const char*, 3> kAxisColours{"#b83227", "#3a8a3f", "#2b5fb0"};
constexpr std::size_t kMaxDots = 1500;  // in the scatter, so that a long run's page stays small

std::vector<FrameResult> of_sequence(const RunReport& report, std::uint32_t sequence) {
  std::vector<FrameResult> found;
  for (const FrameResult& result : report.results) {
    if (result.sequence == sequence) found.push_back(result);
  }
  return found;
}

const ReportPicture* picture_of(const RunReport& report, std::uint32_t sequence, std::uint32_t frame) {
  for (const ReportPicture& picture : report.pictures) {
    if (picture.sequence == sequence && picture.frame == frame) return &picture;
  }
  return nullptr;
}

// Orthographic projection along the boresight, as in the depth image.
void draw_triad(Svg& svg, Point centre, double size, const Eigen::Quaterniond& q_lrf_trf, double width,
                double opacity) {
  const Eigen::Matrix3d axes = q_lrf_trf.normalized().toRotationMatrix();
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return axes(1, a) > axes(1, b); });  // far ones first
  for (const int axis : order) {
    const Point tip{centre.x + size * axes(0, axis), centre.y - size * axes(2, axis)};
    svg.line(centre, tip, {kAxisColours[static_cast<std::size_t>(axis)], width, "", opacity});
    if (opacity == 1.0) svg.circle(tip, 1.5, kAxisColours[static_cast<std::size_t>(axis)]);
  }
}

void draw_strip_column(Svg& svg, const RunReport& report, const FrameResult& result, double x, double side) {
  const Point centre{x + 0.5 * side, 26.0 + side + 0.5 * side + 8.0};
  svg.text({centre.x, 16.0}, fmt::format("{}", result.frame + 1), {"middle", 11.5, "#5a6069"});
  if (const ReportPicture* picture = picture_of(report, result.sequence, result.frame)) {
    svg.image({x, 24.0}, side, png_data_uri(depth_picture(picture->image)));
  } else {
    svg.rectangle({x, 24.0}, side, side, "#f2f3f5");
  }
  draw_triad(svg, centre, 0.46 * side, result.truth, 5.0, 0.28);
  if (result.valid) draw_triad(svg, centre, 0.46 * side, result.rcnn, 1.5, 1.0);
  const double text_y = 26.0 + 2.0 * side + 28.0;
  const std::string rcnn =
      result.valid ? fmt::format("{:.1f}°", error_deg(result, Estimator::kRcnn)) : "none";
  const std::string cnn = result.valid ? fmt::format("{:.1f}°", error_deg(result, Estimator::kCnn)) : "none";
  svg.text({centre.x, text_y}, rcnn, {"middle", 12.0, kRcnnColour, true});
  svg.text({centre.x, text_y + 17.0}, cnn, {"middle", 12.0, kCnnColour});
}

Series component_series(const std::vector<FrameResult>& frames, int component, bool estimate) {
  static constexpr std::array<const char*, 4> kColours{"#4b5563", "#b83227", "#3a8a3f", "#2b5fb0"};
  static constexpr std::array<const char*, 4> kNames{"w", "x", "y", "z"};
  const auto index = static_cast<std::size_t>(component);
  Series series{estimate ? "" : kNames[index], kColours[index], "", {}, estimate};
  Eigen::Quaterniond previous = frames.front().truth;
  for (const FrameResult& frame : frames) {
    // q and -q are one attitude: follow the sign that keeps the curve continuous, for the estimate too.
    Eigen::Quaterniond q = frame.truth;
    if (q.dot(previous) < 0.0) q.coeffs() = -q.coeffs();
    previous = q;
    if (estimate) {
      if (!frame.valid) continue;
      const double sign = frame.rcnn.dot(q) < 0.0 ? -1.0 : 1.0;
      q.coeffs() = sign * frame.rcnn.coeffs();
    }
    const std::array<double, 4> parts{q.w(), q.x(), q.y(), q.z()};
    series.points.push_back({frame.frame + 1.0, parts[index]});
  }
  return series;
}

// The poses of one frame of every sequence, where they are known.
std::vector<PoseErrors> poses_of(const RunReport& report, std::uint32_t frame) {
  std::vector<PoseErrors> poses;
  for (const FrameResult& result : report.results)
    if (result.frame == frame && result.pose.known) poses.push_back(result.pose);
  return poses;
}

// On a logarithmic axis: a value below it is drawn on its edge.
double at_least(double value, double low) {
  return std::max(value, low);
}

// The median of one error over the frames.
Series pose_series(const RunReport& report, const char* name, const char* dash, double PoseErrors::*error,
                   double unit, double low) {
  Series series{name, kPoseColour, dash, {}};
  for (std::uint32_t frame = 0; frame < report.setup.frames; ++frame) {
    std::vector<double> values;
    for (const PoseErrors& pose : poses_of(report, frame)) values.push_back(unit * pose.*error);
    if (!values.empty()) series.points.push_back({frame + 1.0, at_least(median(values), low)});
  }
  return series;
}

LineChart frames_chart(const RunReport& report, const char* description, const char* y_label) {
  LineChart chart;
  chart.description = description;
  chart.x_label = fmt::format("frame (one every {:g} s)", report.frame_period_s);
  chart.y_label = y_label;
  chart.x_low = 1.0;
  chart.x_high = std::max(2.0, static_cast<double>(report.setup.frames));
  return chart;
}

}  // namespace

std::string error_over_frames_figure(const RunReport& report) {
  Series rcnn_mean{"RCNN mean", kRcnnColour, "", {}};
  Series rcnn_median{"median", kRcnnColour, "2 4", {}};
  Series cnn_mean{"CNN mean", kCnnColour, "", {}};
  Series cnn_median{"median", kCnnColour, "2 4", {}};
  for (const CurvePoint& errors : errors_by_frame(report.results, report.setup.frames)) {
    if (errors.rcnn.count == 0) continue;
    rcnn_mean.points.push_back({errors.at, errors.rcnn.mean_deg});
    rcnn_median.points.push_back({errors.at, errors.rcnn.median_deg});
    cnn_mean.points.push_back({errors.at, errors.cnn.mean_deg});
    cnn_median.points.push_back({errors.at, errors.cnn.median_deg});
  }
  LineChart chart;
  chart.description = "Angular error of RCNN and single-frame CNN over the frame number";
  chart.x_label = fmt::format("frame (one every {:g} s)", report.frame_period_s);
  chart.y_label = "angular error [deg]";
  chart.x_low = 1.0;
  chart.x_high = std::max(2.0, static_cast<double>(report.setup.frames));
  chart.series = {rcnn_mean, rcnn_median, cnn_mean, cnn_median};
  if (report.paper.rcnn) {
    chart.series.push_back({"paper", kRcnnColour, "", {{chart.x_high, report.paper.rcnn->mean_deg}}});
  }
  if (report.paper.cnn)
    chart.series.push_back({"", kCnnColour, "", {{chart.x_high, report.paper.cnn->mean_deg}}});
  return line_chart(chart);
}

std::string error_histogram_figure(const RunReport& report) {
  return histogram_figure(
      histogram(last_frame_errors_deg(report.results, report.setup.frames, Estimator::kRcnn)),
      histogram(last_frame_errors_deg(report.results, report.setup.frames, Estimator::kCnn)), {});
}

std::string predicted_error_figure(const RunReport& report) {
  AgreementChart chart;
  chart.description = "Actual angular error over the expected one";
  chart.x_label = "expected error [deg]";
  chart.y_label = "actual error [deg]";
  Series rcnn{"RCNN, every frame", kRcnnColour, "", {}, true};
  Series cnn{"CNN, every frame", kCnnColour, "", {}, true};
  const std::size_t stride = 1 + report.results.size() / kMaxDots;
  for (std::size_t i = 0; i < report.results.size(); i += stride) {
    const FrameResult& result = report.results[i];
    if (!result.valid) continue;
    rcnn.points.push_back({kDegPerRad * result.rcnn_predicted_rad, error_deg(result, Estimator::kRcnn)});
    cnn.points.push_back({kDegPerRad * result.cnn_predicted_rad, error_deg(result, Estimator::kCnn)});
  }
  chart.low = 0.3;
  chart.series = {cnn, rcnn};
  return agreement_chart(chart);
}

std::string pose_attitude_figure(const RunReport& report, std::uint32_t sequence) {
  constexpr double kLow_deg = 0.01;
  LineChart chart = frames_chart(report, "Angular error of network and registered pose over the frame number",
                                 "angular error [deg]");
  chart.logarithmic_y = true;
  chart.y_low = kLow_deg;
  chart.y_high = 180.0;
  Series rcnn{"RCNN median", kRcnnColour, "", {}};
  for (const CurvePoint& errors : errors_by_frame(report.results, report.setup.frames)) {
    if (errors.rcnn.count > 0) rcnn.points.push_back({errors.at, at_least(errors.rcnn.median_deg, kLow_deg)});
  }
  Series verified{"verified", kPoseColour, "", {}, true};
  Series doubtful{"not verified", kDoubtfulPoseColour, "", {}, true};
  for (const FrameResult& result : of_sequence(report, sequence)) {
    if (!result.pose.known) continue;
    Series& series = result.pose.verified ? verified : doubtful;
    series.points.push_back({result.frame + 1.0, at_least(result.pose.turn_deg, kLow_deg)});
  }
  chart.series = {rcnn, pose_series(report, "pose median", "", &PoseErrors::turn_deg, 1.0, kLow_deg)};
  for (const Series& series : {verified, doubtful})
    if (!series.points.empty()) chart.series.push_back(series);
  return line_chart(chart);
}

std::string pose_position_figure(const RunReport& report) {
  constexpr double kLow_mm = 0.1;
  LineChart chart = frames_chart(report, "Error of the registered position over the frame number",
                                 "error of the position [mm]");
  chart.logarithmic_y = true;
  chart.y_low = kLow_mm;
  chart.y_high = 1000.0;
  chart.series = {pose_series(report, "across", "", &PoseErrors::across_m, 1e3, kLow_mm),
                  pose_series(report, "along", "6 4", &PoseErrors::along_m, 1e3, kLow_mm)};
  for (const Series& series : chart.series)
    for (const Point& point : series.points) chart.y_high = std::max(chart.y_high, point.y);
  return line_chart(chart);
}

std::string pose_verified_figure(const RunReport& report) {
  LineChart chart =
      frames_chart(report, "Share of verified poses over the frame number", "share of the sequences [%]");
  chart.y_high = 100.0;
  Series verified{"verified", kPoseColour, "", {}};
  Series wrong{"verified and wrong", kDoubtfulPoseColour, "", {}};
  for (std::uint32_t frame = 0; frame < report.setup.frames; ++frame) {
    const PoseSummary summary = pose_summary(report.results, frame);
    if (summary.count == 0) continue;
    verified.points.push_back({frame + 1.0, 100.0 * summary.verified});
    wrong.points.push_back({frame + 1.0, 100.0 * summary.verified_wrong});
  }
  chart.series = {verified, wrong};
  return line_chart(chart);
}

std::string attitude_strip_figure(const RunReport& report, std::uint32_t sequence) {
  constexpr double kLabels = 66.0;
  constexpr double kGap = 6.0;
  const std::vector<FrameResult> all = of_sequence(report, sequence);
  const std::size_t columns = std::min<std::size_t>(all.size(), 10);
  const double side = 90.0;
  Svg svg(kLabels + 10.0 * (side + kGap), 2.0 * side + 80.0,
          "Depth images, true and estimated body axes and errors of one sequence, frame by frame");
  svg.text({0.0, 16.0}, "frame", {"start", 11.5, "#5a6069"});
  svg.text({0.0, 24.0 + 0.5 * side}, "depth", {"start", 11.5, "#5a6069"});
  svg.text({0.0, 30.0 + 1.5 * side}, "axes", {"start", 11.5, "#5a6069"});
  for (int axis = 0; axis < 3; ++axis) {
    svg.text({15.0 * axis, 48.0 + 1.5 * side}, std::string(1, static_cast<char>('x' + axis)),
             {"start", 13.0, kAxisColours[static_cast<std::size_t>(axis)], true});
  }
  svg.text({0.0, 26.0 + 2.0 * side + 28.0}, "RCNN", {"start", 12.0, kRcnnColour, true});
  svg.text({0.0, 26.0 + 2.0 * side + 45.0}, "CNN", {"start", 12.0, kCnnColour});
  for (std::size_t column = 0; column < columns; ++column) {
    // The last column is the last frame, however many there are.
    const std::size_t index = columns < 2 ? 0 : column * (all.size() - 1) / (columns - 1);
    draw_strip_column(svg, report, all[index], kLabels + static_cast<double>(column) * (side + kGap), side);
  }
  return svg.text();
}

std::string quaternion_figure(const RunReport& report, std::uint32_t sequence) {
  const std::vector<FrameResult> frames = of_sequence(report, sequence);
  if (frames.empty()) return {};
  LineChart chart;
  chart.description = "Quaternion components of one sequence, true and estimated";
  chart.x_label = "frame";
  chart.y_label = "quaternion component";
  chart.x_low = 1.0;
  chart.x_high = std::max(2.0, static_cast<double>(report.setup.frames));
  chart.y_low = -1.0;
  chart.y_high = 1.0;
  for (int component = 0; component < 4; ++component) {
    chart.series.push_back(component_series(frames, component, false));
  }
  for (int component = 0; component < 4; ++component) {
    chart.series.push_back(component_series(frames, component, true));
  }
  return line_chart(chart);
}

std::string gallery_figure(const std::vector<const ReportPicture*>& pictures) {
  constexpr double kSide = 120.0;
  constexpr double kGap = 8.0;
  constexpr std::size_t kColumns = 8;
  const std::size_t rows = (pictures.size() + kColumns - 1) / kColumns;
  Svg svg(kColumns * (kSide + kGap) - kGap, static_cast<double>(rows) * (kSide + 26.0),
          "Depth images of other sequences: sequence, frame and range");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const double x = static_cast<double>(i % kColumns) * (kSide + kGap);
    const double y = static_cast<double>(i / kColumns) * (kSide + 26.0);
    svg.image({x, y}, kSide, png_data_uri(depth_picture(pictures[i]->image)));
    svg.text({x + 0.5 * kSide, y + kSide + 16.0},
             fmt::format("{} / {}, {:.0f} m", pictures[i]->sequence + 1, pictures[i]->frame + 1,
                         pictures[i]->range_m),
             {"middle", 11.5, "#5a6069"});
  }
  return svg.text();
}

}  // namespace tumblesight::sim
