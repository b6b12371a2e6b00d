#include "sim/report/run_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sim/evaluation/chance.hpp"
#include "sim/evaluation/results.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/host/text.hpp"
#include "sim/report/error_tables.hpp"
#include "sim/report/page.hpp"
#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMaxGalleryPictures = 8;

ErrorSummary last_frame_errors(const RunReport& report, Estimator estimator) {
  return last_frame_summary(report.results, report.setup.frames, estimator);
}

// Nothing without poses.
std::string pose_sentence(const RunReport& report) {
  if (run_poses_table(report).rows.empty()) return {};
  const PoseSummary pose = pose_summary(report.results, report.setup.frames - 1);
  return fmt::format(
      " The registered pose's is {:.2f}° (median {:.2f}°), and {:.0f} % of the poses are verified.",
      pose.mean_deg, pose.median_deg, 100.0 * pose.verified);
}

std::string lead_sentence(const RunReport& report) {
  const ErrorSummary rcnn = last_frame_errors(report, Estimator::kRcnn);
  if (rcnn.count == 0) return "No sequence was answered completely, so there is no error to report.";
  const auto within = static_cast<std::size_t>(rcnn.within_20deg * static_cast<double>(rcnn.count) + 0.5);
  const std::string wrong = mostly_wrong_text(report);
  return fmt::format(
      "{}After {} the network's mean attitude error is {:.1f}° (median {:.1f}°). It is within 20° in {} of "
      "{} "
      "sequences.{} {} of {} steps were answered. The flight task allocated {} after its start.",
      wrong.empty() ? "" : not_known_sentence(report.setup.target) + " " + wrong + " ",
      counted(report.setup.frames, "frame"), rcnn.mean_deg, rcnn.median_deg, within, rcnn.count,
      pose_sentence(report), report.steps_planned - report.steps_missed - report.frames_superseded,
      report.steps_planned,
      report.heap_allocations == 0 ? "no heap memory"
                                   : fmt::format("heap memory {} times", report.heap_allocations));
}

// Nothing without poses.
std::string poses_section(const RunReport& report, std::uint32_t shown) {
  if (run_poses_table(report).rows.empty()) return {};
  return html_figure(
             "Attitude of the registered pose", pose_attitude_figure(report, shown),
             fmt::format("Lines: medians of all sequences. Dots: the pose of sequence {}, by whether the "
                         "flight program has verified it.",
                         shown + 1)) +
         html_figure("Position of the registered pose", pose_position_figure(report),
                     "Medians of all sequences: error of the target frame's origin, perpendicular to the "
                     "boresight and on it.") +
         html_figure("Verified poses", pose_verified_figure(report),
                     "Share of the sequences whose pose the flight program has verified. Wrong: more than 5° "
                     "off.");
}

std::string charts_section(const RunReport& report, std::uint32_t shown) {
  return "<div class=pair>\n" +
         html_figure("Error over the frames", error_over_frames_figure(report),
                     std::string("The RCNN combines all frames so far. The CNN sees each frame alone.") +
                         (report.paper.rcnn ? " Circles: the paper's means, last frame." : "")) +
         html_figure(
             "Distribution of the last frame's error", error_histogram_figure(report),
             "Errors near 90° and 180° are attitudes confused with nearly symmetric ones of the target.") +
         html_figure("Expected and actual error", predicted_error_figure(report),
                     "Below the dashed line the error is smaller than expected, above it larger.") +
         html_figure(
             fmt::format("Quaternion of sequence {}", shown + 1), quaternion_figure(report, shown),
             "Lines: true. Dots: RCNN. The sign is chosen for continuity. TRF to LRF, scalar w first.") +
         poses_section(report, shown) + "</div>\n";
}

// Pictures of sequences other than the one shown frame by frame, evenly spread over those that were kept.
std::string gallery_section(const RunReport& report, std::uint32_t shown) {
  std::vector<const ReportPicture*> others;
  for (const ReportPicture& picture : report.pictures) {
    if (picture.sequence != shown) others.push_back(&picture);
  }
  if (others.empty()) return {};
  const std::size_t count = std::min(others.size(), kMaxGalleryPictures);
  std::vector<const ReportPicture*> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(others[i * others.size() / count]);
  return html_figure("Input of the network", gallery_figure(chosen),
                     "Frames of other sequences as the network receives them: 100 × 100 cells perpendicular "
                     "to the boresight, nearer is "
                     "brighter. Below each: sequence / frame, range.");
}

std::string body(const RunReport& report) {
  const std::uint32_t shown = report.results.empty() ? 0 : report.results.front().sequence;
  std::string html =
      fmt::format("<h1>Attitude of {}, {} condition</h1>\n", escape_markup(display_name(report.setup.target)),
                  escape_markup(report.setup.condition));
  html += fmt::format("<p class=sub>Software-in-the-loop run of Tumblesight: {} of {}, {:g} s apart</p>\n",
                      counted(report.setup.sequences, "sequence"), counted(report.setup.frames, "frame"),
                      report.frame_period_s);
  if (!report.setup.symmetry.is_none())
    html += fmt::format("<p class=sub>Errors modulo the symmetry of the target: {}.</p>\n",
                        to_string(report.setup.symmetry));
  html += html_notices(report.notices, report.setup.remarks);
  html += fmt::format("<p class=lead>{}</p>\n", lead_sentence(report)) +
          html_text(run_errors_table(report), "headline") +
          html_text(transposed(run_poses_table(report)), "poses");
  if (!report.results.empty()) {
    html += html_figure(fmt::format("Sequence {}, frame by frame", shown + 1),
                        attitude_strip_figure(report, shown),
                        "Top: the depth image that the network receives, nearer is brighter. Middle: the "
                        "target's axes seen along the "
                        "boresight, true (broad, pale) and as the RCNN estimates them (thin, dark). Bottom: "
                        "angular errors.") +
            charts_section(report, shown) + gallery_section(report, shown);
  }
  return html + html_console(report.recording) + html_facts(report.facts) +
         html_footer(report.generated, report.command);
}

}  // namespace

DataTable run_errors_table(const RunReport& report) {
  return estimators_table(
      {{"RCNN, " + counted(report.setup.frames, "frame"), Mark::kRcnn,
        last_frame_errors(report, Estimator::kRcnn), report.paper.rcnn},
       {"CNN, last frame alone", Mark::kCnn, last_frame_errors(report, Estimator::kCnn), report.paper.cnn}},
      report.paper.sequences);
}

DataTable run_poses_table(const RunReport& report) {
  return poses_table({{report.setup.condition, pose_summary(report.results, 0),
                       pose_summary(report.results, report.setup.frames - 1)}});
}

std::string mostly_wrong_text(const RunReport& report) {
  if (!show_the_target(report.setup.effects)) return {};
  return mostly_wrong_text(last_frame_errors(report, Estimator::kRcnn), report.setup.symmetry);
}

std::string run_page(const RunReport& report) {
  return html_page(fmt::format("{}, {}", report.setup.target, report.setup.condition), body(report));
}

}  // namespace tumblesight::sim
