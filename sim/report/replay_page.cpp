#include <fmt/format.h>

#include <algorithm>

#include "sim/evaluation/statistics.hpp"
#include "sim/host/text.hpp"
#include "sim/report/charts.hpp"
#include "sim/report/colours.hpp"
#include "sim/report/page.hpp"
#include "sim/report/replay_report.hpp"
#include "sim/report/svg.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kLowest_deg = 0.1;
constexpr double kHighest_deg = 180.0;
constexpr std::size_t kMaxGalleryPictures = 8;

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

// Every cycle over the time: error where the truth is known, expected error, and where there is no attitude.
std::string timeline_figure(const ReplayReport& report) {
  Series error{"error", kRcnnColour, "", {}, true};
  Series expected{"expected error", kCnnColour, "", {}, true};
  Series refused{"refused", "#b83227", "", {}, true};
  Series missing{"no frame", kBaselineColour, "", {}, true};
  LineChart chart;
  for (const ReplayRow& row : report.rows) {
    const double time_s = 1e-9 * static_cast<double>(row.time_ns - report.rows.front().time_ns);
    chart.x_high = std::max(chart.x_high, time_s);
    if (row.has_attitude)
      expected.points.push_back({time_s, 1e-6 * kDegPerRad * row.attitude.predicted_error_urad});
    if (row.error_deg) error.points.push_back({time_s, *row.error_deg});
    if (row.refusal) refused.points.push_back({time_s, kLowest_deg});
    if (row.attitude.validity == hal::Validity::kNoFrame) missing.points.push_back({time_s, kLowest_deg});
  }
  chart.description = "Error, expected error, and cycles without an attitude over the time";
  chart.x_label = "time since the first cycle [s]";
  chart.y_label = "angle [deg]";
  chart.y_low = kLowest_deg;
  chart.y_high = kHighest_deg;
  chart.logarithmic_y = true;
  chart.x_ticks = round_ticks(0.0, chart.x_high, 8);
  chart.x_high = chart.x_ticks.back();
  for (const Series& series : {expected, error, missing, refused}) {
    if (!series.points.empty()) chart.series.push_back(series);
  }
  return line_chart(chart);
}

std::string gallery(const ReplayReport& report) {
  const std::vector<ReportPicture>& pictures = report.run.pictures;
  std::vector<const ReportPicture*> chosen;
  const std::size_t count = std::min(pictures.size(), kMaxGalleryPictures);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(&pictures[i * pictures.size() / count]);
  return chosen.empty() ? "" : gallery_figure(chosen);
}

std::string lead_sentence(const ReplayReport& report) {
  const auto has_attitude = [](const ReplayRow& row) { return row.has_attitude; };
  const auto attitudes = std::count_if(report.rows.begin(), report.rows.end(), has_attitude);
  std::string text = mostly_wrong_text(report);
  if (!text.empty()) text = not_known_sentence(report.setup.target) + " " + text + " ";
  const std::string nothing = nothing_accepted_text(report);
  if (!nothing.empty()) text += nothing + " ";
  text += fmt::format("The flight program gave {} to {} of the recording.",
                      counted(static_cast<std::uint64_t>(attitudes), "attitude"),
                      counted(report.setup.frames, "frame"));
  if (report.setup.truth.empty())
    text += " The truth is not known, so the errors are those that it expects itself.";
  return text;
}

std::string strip_section(const ReplayReport& report) {
  if (report.run.results.empty()) return {};
  return html_figure(
      "The first track, frame by frame",
      attitude_strip_figure(report.run, report.run.results.front().sequence),
      "Top: the depth image that the network receives, nearer is brighter. Middle: the target's "
      "axes seen along the boresight, true (broad, pale) and as the RCNN estimates them (thin, "
      "dark). Bottom: angular errors.");
}

std::string charts_section(const ReplayReport& report) {
  if (report.rows.empty()) return {};
  std::string html =
      "<div class=pair>\n" +
      html_figure("Over the time", timeline_figure(report),
                  "Dots at the bottom edge are cycles without an attitude: no frame, or a refused one.");
  if (!report.run.results.empty())
    html += html_figure("Expected and actual error", predicted_error_figure(report.run),
                        "Below the dashed line the error is smaller than expected, above it larger.") +
            html_figure("Error over the frames of a track", error_over_frames_figure(report.run),
                        "The RCNN combines all frames of the track. The CNN sees each frame alone.");
  return html + "</div>\n";
}

std::string body(const ReplayReport& report) {
  std::string html = fmt::format("<h1>Replay of {}</h1>\n", escape_markup(file_name(report.setup.recording)));
  html +=
      fmt::format("<p class=sub>{} as the target, {}, truth: {}</p>\n", escape_markup(report.setup.target),
                  counted(report.run.steps_planned, "cycle"),
                  report.setup.truth.empty() ? "not known" : escape_markup(file_name(report.setup.truth)));
  html += html_notices(report.run.notices, report.setup.remarks);
  html += fmt::format("<p class=lead>{}</p>\n", lead_sentence(report));
  const DataTable errors = replay_errors_table(report);
  if (!errors.rows.empty()) html += html_text(errors, "headline");
  html += strip_section(report) + charts_section(report);
  html += html_figure(
      "Input of the network", gallery(report),
      "Frames as the network receives them: 100 × 100 cells perpendicular to the line of sight, nearer is "
      "brighter. Below each: track / frame, range. Frames that are mirrored, turned or cut off show here.");
  html += html_facts(report.run.facts);
  html += "<h2>Cycles</h2>\n" + html_text(replay_table(report), "results");
  return html + html_console(report.run.recording) + html_footer(report.run.generated, report.run.command);
}

}  // namespace

std::string replay_page(const ReplayReport& report) {
  return html_page(fmt::format("replay of {}", file_name(report.setup.recording)), body(report));
}

}  // namespace tumblesight::sim
