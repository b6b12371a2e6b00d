#include "sim/evaluation/report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "sim/evaluation/report_figures.hpp"
#include "sim/evaluation/svg.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostGalleryPictures = 8;

constexpr const char* kStyle = R"css(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: #22262d; line-height: 1.5; font-size: 15px;
       font-family: "Inter", "Helvetica Neue", "Segoe UI", Arial, "Liberation Sans", sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 44px 32px 56px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 18px; margin: 40px 0 6px; }
p { margin: 6px 0 14px; max-width: 46em; }
.sub { color: #6b7280; margin-bottom: 20px; }
.notice.remark { border-color: #b58a1b; background: #fcf8ec; }
.notice + .lead { margin-top: 20px; }
.lead { font-size: 18px; line-height: 1.45; max-width: 44em; margin: 0 0 22px; }
.notice { border-left: 4px solid #b83227; background: #fdf3f2; padding: 10px 16px; margin: 0 0 10px; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: #4b5563; border-bottom: 1.5px solid #22262d; }
th, td { padding: 6px 22px 6px 0; }
td { border-bottom: 1px solid #e4e6ea; }
.number { text-align: right; }
.headline { width: 100%; }
.headline td:first-child { font-weight: 600; }
.headline tr.paper td, .headline tr.paper td:first-child { color: #6b7280; font-weight: 400; }
.headline tr.paper td:first-child { padding-left: 18px; }
.rcnn { color: #1b5e9e; } .cnn { color: #b65a1b; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 8px 40px; }
figure { margin: 0; break-inside: avoid; }
figcaption { font-size: 13px; color: #5a6069; margin-top: 4px; max-width: 60em; }
.pair h2 { margin-top: 32px; }
svg { display: block; width: 100%; height: auto; font-family: inherit; }
.facts { display: grid; grid-template-columns: repeat(3, 1fr); gap: 0 40px; align-items: start; }
.facts table { width: 100%; font-size: 13px; }
.facts td { padding: 4px 0; vertical-align: top; }
.facts td:last-child { text-align: right; padding-left: 14px; }
.facts td { white-space: nowrap; }
footer { margin-top: 40px; color: #6b7280; font-size: 13px; border-top: 1px solid #e4e6ea; padding-top: 12px; }
code { font-family: "SF Mono", Consolas, "DejaVu Sans Mono", monospace; font-size: 12px; overflow-wrap: anywhere; }
@media (max-width: 760px) { .pair, .facts { grid-template-columns: 1fr; } main { padding: 24px 16px; } }
@media print { main { max-width: none; padding: 0; } body { font-size: 11pt; } .lead { font-size: 13pt; }
  .notice, svg, img { print-color-adjust: exact; -webkit-print-color-adjust: exact; } @page { margin: 16mm; } }
)css";

// The targets' names as people write them.
std::string display_name(const std::string& target) {
  if (target == "near_shoemaker") return "NEAR Shoemaker";
  if (target == "magellan") return "Magellan";
  if (target == "sacd_aquarius") return "SAC-D/Aquarius";
  return target;
}

std::string percent(double share) {
  return fmt::format("{:.1f} %", 100.0 * share);
}

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
      "<tr><td class=\"{}\">{}</td><td class=number>{:.2f}°</td><td class=number>{:.2f}°</td>"
      "<td class=number>{}</td><td class=number>{}</td><td class=number>{}</td></tr>\n",
      css_class, name, summary.mean_deg, summary.median_deg, percent(summary.within_20deg),
      percent(summary.within_5deg), summary.count);
}

std::string paper_row(const std::optional<PaperFigure>& figure) {
  if (!figure) return {};
  return fmt::format(
      "<tr class=paper><td>in the paper</td><td class=number>{:.2f}°</td><td class=number>–</td>"
      "<td class=number>{:.0f} %</td><td class=number>–</td><td class=number>900</td></tr>\n",
      figure->mean_deg, 100.0 * figure->within_20deg);
}

std::string headline_table(const RunReport& report) {
  return "<table class=headline><thead><tr><th>angular error of the last frame</th><th class=number>mean</th>"
         "<th class=number>median</th><th class=number>within 20°</th><th class=number>within 5°</th>"
         "<th class=number>sequences</th></tr></thead><tbody>\n" +
         summary_row("rcnn", "RCNN, all frames",
                     summarise(last_frame_errors_deg(report.results, report.frames, Estimator::kRcnn))) +
         paper_row(report.paper.rcnn) +
         summary_row("cnn", "CNN, last frame alone",
                     summarise(last_frame_errors_deg(report.results, report.frames, Estimator::kCnn))) +
         paper_row(report.paper.cnn) + "</tbody></table>\n";
}

std::string figure(const std::string& heading, const std::string& svg, const std::string& caption) {
  return fmt::format("<figure><h2>{}</h2>\n{}<figcaption>{}</figcaption></figure>\n", heading, svg, caption);
}

std::string charts_section(const RunReport& report, std::uint32_t shown) {
  return "<div class=pair>\n" +
         figure("Error over the frames", error_over_frames_figure(report),
                std::string("The recurrent network gathers what single frames leave open; the CNN sees each "
                            "frame alone.") +
                    (report.paper.rcnn ? " Circles: the paper's means, last frame." : "")) +
         figure("Distribution of the last frame's error", error_histogram_figure(report),
                "Errors near 90° and 180° are attitudes confused with the target's quasi-symmetric ones.") +
         figure("Predicted against actual error", predicted_error_figure(report),
                "Below the dashed line the estimate is better than the network claims, above it worse.") +
         figure(fmt::format("Quaternion of sequence {}", shown + 1), quaternion_figure(report, shown),
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
  return figure(
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
        figure(
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
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Tumblesight: {}, "
      "{}</title>\n<style>{}</style>\n</head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
      escape_markup(report.target), escape_markup(report.condition), kStyle, body(report));
}

void write_text_file(const std::string& path, const std::string& content) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!parent.empty()) std::filesystem::create_directories(parent, error);
  if (error) throw std::runtime_error("cannot create folder '" + parent.string() + "': " + error.message());
  // Written beside and renamed, so that a reader never finds half a file.
  const std::string partial = path + "." + std::to_string(getpid()) + ".partial";
  errno = 0;
  std::ofstream file(partial, std::ios::binary);
  file << content;
  file.close();
  const int reason = errno;
  if (!file || std::rename(partial.c_str(), path.c_str()) != 0) {
    const std::string message = std::strerror(reason != 0 ? reason : errno);
    std::filesystem::remove(partial, error);
    throw std::runtime_error("cannot write '" + path + "': " + message);
  }
}

}  // namespace tumblesight::sim
