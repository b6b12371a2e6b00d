#include "sim/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/evaluation/results.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/report/page.hpp"
#include "sim/report/report_figures.hpp"
#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostGalleryPictures = 8;

std::string lead_sentence(const RunReport& report) {
  const ErrorSummary rcnn = summarise(last_frame_errors_deg(report.results, report.frames, Estimator::kRcnn));
  if (rcnn.count == 0) return "No sequence was answered to its end: there is no error to report.";
  const auto within = static_cast<std::size_t>(rcnn.within_20deg * static_cast<double>(rcnn.count) + 0.5);
  return fmt::format(
      "After {} frames the flight program knows the target's attitude to {:.1f}° on average (median "
      "{:.1f}°), and "
      "to within 20° in {} of {} sequences. {} of {} steps were answered; the flight task allocated {} after "
      "its "
      "start.",
      report.frames, rcnn.mean_deg, rcnn.median_deg, within, rcnn.count,
      report.steps_planned - report.steps_missed, report.steps_planned,
      report.heap_allocations == 0 ? "no heap memory"
                                   : fmt::format("heap memory {} times", report.heap_allocations));
}

std::string summary_row(const char* css_class, const char* name, const ErrorSummary& summary) {
  if (summary.count == 0)
    return fmt::format("<tr><td class=\"{}\">{}</td><td class=number colspan=5>–</td></tr>\n", css_class,
                       name);
  return fmt::format(
      "<tr><td class=\"{}\">{}</td><td class=number>{}</td><td class=number>{}</td>"
      "<td class=number>{}</td><td class=number>{}</td><td class=number>{}</td></tr>\n",
      css_class, name, degrees_text(summary.mean_deg, summary.mean_standard_error_deg),
      degrees_text(summary.median_deg), percent_text(summary.within_20deg, summary.count),
      percent_text(summary.within_5deg, summary.count), summary.count);
}

std::string paper_row(const std::optional<PaperFigure>& figure, std::uint32_t sequences) {
  if (!figure) return {};
  return fmt::format(
      "<tr class=paper><td>in the paper</td><td class=number>{:.2f}°</td><td class=number>–</td>"
      "<td class=number>{:.0f} %</td><td class=number>–</td><td class=number>{}</td></tr>\n",
      figure->mean_deg, 100.0 * figure->within_20deg, sequences);
}

std::string headline_table(const RunReport& report) {
  return "<table class=headline><thead><tr><th>angular error of the last frame</th><th class=number>mean</th>"
         "<th class=number>median</th><th class=number>within 20°</th><th class=number>within 5°</th>"
         "<th class=number>sequences</th></tr></thead><tbody>\n" +
         summary_row("rcnn", "RCNN, all frames",
                     summarise(last_frame_errors_deg(report.results, report.frames, Estimator::kRcnn))) +
         paper_row(report.paper.rcnn, report.paper.sequences) +
         summary_row("cnn", "CNN, last frame alone",
                     summarise(last_frame_errors_deg(report.results, report.frames, Estimator::kCnn))) +
         paper_row(report.paper.cnn, report.paper.sequences) + "</tbody></table>\n";
}

std::string charts_section(const RunReport& report, std::uint32_t shown) {
  return "<div class=pair>\n" +
         html_figure(
             "Error over the frames", error_over_frames_figure(report),
             std::string("The recurrent network gathers what single frames leave open; the CNN sees each "
                         "frame alone.") +
                 (report.paper.rcnn ? " Circles: the paper's means, last frame." : "")) +
         html_figure(
             "Distribution of the last frame's error", error_histogram_figure(report),
             "Errors near 90° and 180° are attitudes confused with the target's quasi-symmetric ones.") +
         html_figure(
             "Predicted against actual error", predicted_error_figure(report),
             "Below the dashed line the estimate is better than the network claims, above it worse.") +
         html_figure(fmt::format("Quaternion of sequence {}", shown + 1), quaternion_figure(report, shown),
                     "Lines: truth. Dots: RCNN. Sign chosen for continuity; TRF to LRF, scalar w first.") +
         "</div>\n";
}

// Pictures of other sequences than the one shown frame by frame, spread over what was kept.
std::string gallery_section(const RunReport& report, std::uint32_t shown) {
  std::vector<const ReportPicture*> others;
  for (const ReportPicture& picture : report.pictures) {
    if (picture.sequence != shown) others.push_back(&picture);
  }
  if (others.empty()) return {};
  const std::size_t count = std::min(others.size(), kMostGalleryPictures);
  std::vector<const ReportPicture*> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(others[i * others.size() / count]);
  return html_figure(
      "What the flight program sees", gallery_figure(chosen),
      "Frames of other sequences as the network receives them: 100 × 100 cells across the boresight, "
      "nearer is brighter. Below each: sequence / frame, range.");
}

std::string facts_section(const RunReport& report) {
  std::string html = "<div class=facts>\n";
  for (const FactList& list : report.facts) {
    html += fmt::format("<section><h2>{}</h2><table>", escape_markup(list.title));
    for (const auto& [name, value] : list.facts) {
      html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escape_markup(name), escape_markup(value));
    }
    html += "</table></section>\n";
  }
  return html + "</div>\n";
}

std::string body(const RunReport& report) {
  const std::uint32_t shown = report.results.empty() ? 0 : report.results.front().sequence;
  std::string html = fmt::format("<h1>Attitude of {}, {} condition</h1>\n",
                                 escape_markup(display_name(report.target)), escape_markup(report.condition));
  html += fmt::format(
      "<p class=sub>Software-in-the-loop run of Tumblesight: {} sequences of {} frames, {:.1f} s apart</p>\n",
      report.sequences, report.frames, report.frame_period_s);
  for (const std::string& notice : report.notices) {
    html += fmt::format("<div class=notice>{}</div>\n", escape_markup(notice));
  }
  for (const std::string& remark : report.remarks) {
    html += fmt::format("<div class=\"notice remark\">{}</div>\n", escape_markup(remark));
  }
  html += fmt::format("<p class=lead>{}</p>\n", lead_sentence(report)) + headline_table(report);
  if (!report.results.empty()) {
    html +=
        html_figure(
            fmt::format("Sequence {}, frame by frame", shown + 1), attitude_strip_figure(report, shown),
            "Top: the depth image the network receives, nearer is brighter. Below: the target's axes seen "
            "along "
            "the boresight, broad and pale as they are, thin and dark as the RCNN estimates them. Then the "
            "angular errors.") +
        charts_section(report, shown) + gallery_section(report, shown);
  }
  html += facts_section(report);
  html += fmt::format("<footer>{}<br><code>{}</code></footer>\n", escape_markup(report.generated),
                      escape_markup(report.command));
  return html;
}

}  // namespace

std::string compose_report(const RunReport& report) {
  return html_page(fmt::format("{}, {}", report.target, report.condition), body(report));
}

}  // namespace tumblesight::sim
