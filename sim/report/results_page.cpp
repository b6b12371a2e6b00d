#include <fmt/format.h>

#include "sim/evaluation/chance.hpp"
#include "sim/evaluation/checks.hpp"
#include "sim/evaluation/pose_goals.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/host/text.hpp"
#include "sim/report/colours.hpp"
#include "sim/report/error_figures.hpp"
#include "sim/report/page.hpp"
#include "sim/report/results_files.hpp"
#include "sim/report/results_tables.hpp"
#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

std::string overview_section(const Results& results) {
  return html_text(conditions_table(results.subjects, kPageOverview), "results") +
         "<p class=sub>Mean angular error of the last frame ± one standard error, and the share of the "
         "sequences within 20°. RCNN: from all frames. CNN: from the last frame alone. Templates: classical "
         "template matching of the last frame with renderings of the same mesh, refined by iterative closest "
         "points (ICP), on the first sequences of each condition. Goals: <span class=met>met</span>, <span "
         "class=missed>missed</span>.</p>\n";
}

// Nothing without poses.
std::string poses_section(const Results& results) {
  std::string text;
  for (const SubjectResult& subject : results.subjects) {
    const DataTable table = poses_table(subject);
    if (table.rows.empty()) continue;
    if (results.subjects.size() > 1) text += "<h3>" + escape_markup(title_of(subject)) + "</h3>\n";
    text += html_text(transposed(table), "poses");
  }
  if (text.empty()) return text;
  return "<h2>Registered pose</h2>\n" + text +
         "<p class=sub>Registration with the surface mesh in the model image. Last frame unless the first is "
         "named. Across and along: error of the target frame's origin, perpendicular to the boresight and on "
         "it. Lengths and rates are means over the poses within 20°; shares are of all sequences. Wrong: "
         "more "
         "than 5° off. Inside 95 %: share of the verified poses whose attitude and position lie in the 95 % "
         "ellipsoid of their covariance.</p>\n";
}

// The table is wide: with few lines it stands better the other way round, with many it scrolls.
std::string goals_html(const DataTable& table) {
  constexpr std::size_t kFewLines = 6;
  if (table.rows.size() <= kFewLines) return html_text(transposed(table), "poses");
  return "<div style=\"overflow-x:auto\">" + html_text(table, "results") + "</div>\n";
}

// The rates of what must not happen, and the sequences in which it did or nearly did.
std::string rare_events_section(const Results& results) {
  std::string text = "<h2>Rare events</h2>\n";
  for (const SubjectResult& subject : results.subjects) {
    if (results.subjects.size() > 1) text += "<h3>" + escape_markup(title_of(subject)) + "</h3>\n";
    text += "<div style=\"overflow-x:auto\">" + html_text(rare_events_table(subject), "results") + "</div>\n";
    for (const CellResult* cell : all_cells(subject)) {
      text += fmt::format("<details><summary>Worst sequences, {}</summary>\n{}",
                          escape_markup(run_name(*cell)), html_text(worst_sequences_table(*cell), "results"));
      if (!cell->replay.empty() && !cell->rare.worst.empty())
        text += fmt::format("<p class=sub>To see the worst: <code>{}{}</code></p>\n",
                            escape_markup(cell->replay), cell->rare.worst.front().sequence);
      text += "</details>\n";
    }
  }
  return text +
         "<p class=sub>Last frames that went wrong, of all last frames, with exact (Clopper-Pearson) bounds: "
         "the true rate is above the lower one with probability 97.5 %, and below the upper one likewise. "
         "Worst: "
         "first verified poses more than 5° off, then wrong attitudes that are called valid, then poses more "
         "than "
         "20° off, then the others; each by the error of the network's attitude.</p>\n";
}

// Nothing without runs that have a goal.
std::string goals_section(const Results& results) {
  std::string text;
  for (const SubjectResult& subject : results.subjects) {
    const DataTable table = goals_table(subject);
    if (table.rows.empty()) continue;
    if (results.subjects.size() > 1) text += "<h3>" + escape_markup(title_of(subject)) + "</h3>\n";
    text += goals_html(table);
  }
  if (text.empty()) return text;
  return "<h2>Goals</h2>\n" + text +
         "<p class=sub>Last frame. Pose: registered; the goal is a mean error of the poses within 20° and a "
         "share of all sequences. Wrong and valid: the network's attitude is more than 20° off and the "
         "report calls it valid. Trust: at most 1 % wrong and valid, at least 97 % of the right ones valid "
         "(99.5 % under the paper's conditions), at least 97 % of the errors below three times the expected "
         "one, mean expected error 0.7 to 1.5 of the real one.</p>\n";
}

// One network on one mesh: its error under each condition.
std::string lead_of(const SubjectResult& subject) {
  std::string errors, wrong;
  for (const CellResult& cell : subject.cells) {
    if (is_mostly_wrong(cell))
      wrong += fmt::format(" Condition {}: {}", to_string(cell.condition),
                           mostly_wrong_text(cell.rcnn, cell.symmetry));
    errors += fmt::format("{}{} ({})", errors.empty() ? "" : ", ",
                          figure_cell(summary_figure(&ErrorSummary::mean_deg), cell.rcnn).text,
                          to_string(cell.condition));
  }
  if (!wrong.empty()) return not_known_sentence(subject.target) + wrong;
  return fmt::format("After {} frames the mean error of the attitude of {} is {}.",
                     subject.cells.front().frames, escape_markup(display_name(subject.target)), errors);
}

// Many: how they compare with the paper and with the goals of the registered pose.
std::string lead_of(const std::vector<SubjectResult>& subjects) {
  std::size_t published = 0;
  std::size_t better = 0;
  std::size_t goals = 0;
  std::size_t met = 0;
  for (const SubjectResult& subject : subjects) {
    for (const CellResult& cell : subject.cells) {
      const PaperFigures paper = paper_figures(subject.target, cell);
      if (!paper.rcnn) continue;
      ++published;
      if (cell.rcnn.mean_deg < paper.rcnn->mean_deg) ++better;
      const std::optional<PoseGoal> goal = pose_goal(subject.target, cell);
      if (!goal || !(cell.pose.known > 0.0)) continue;
      ++goals;
      if (meets(cell.pose, *goal)) ++met;
    }
  }
  return fmt::format(
      "For {} lines of the table the paper published a figure. In {} of them the mean error of the network "
      "here is smaller. The registered pose meets the goal that this project set itself in {} of {} lines.",
      published, better, met, goals);
}

std::string lead_sentence(const Results& results) {
  const bool single = results.subjects.size() == 1 && !results.subjects.front().cells.empty();
  return single ? lead_of(results.subjects.front()) : lead_of(results.subjects);
}

std::string confusion_section(const SubjectResult& subject) {
  std::vector<Named<Confusion>> rows;
  for (const CellResult& cell : subject.cells)
    rows.push_back({to_string(cell.condition), "", cell.rcnn_confusion});
  return html_figure(
      "Confused attitudes", confusion_figure(rows),
      "RCNN, last frame: the share within 20° of the true attitude (right), or of the attitude turned about "
      "z, where the target looks nearly the same. Blur: mean error to the nearest of these attitudes.");
}

std::string reliability_section(const SubjectResult& subject) {
  std::vector<Named<std::vector<ReliabilityBin>>> lines;
  for (const CellResult& cell : subject.cells) {
    lines.push_back({to_string(cell.condition), colour_of(cell.condition), cell.reliability});
  }
  return html_figure("Expected and actual error", reliability_figure(lines),
                     "RCNN, every frame, in tenths sorted by the expected error. On the dashed line the "
                     "expected error is right on average. Above it the network is overconfident.") +
         html_figure(
             "Detection of wrong estimates", detection_figure(detection_of(subject)),
             "RCNN, every frame of all conditions. Wrong: more than 20° off. Each mark is a threshold on the "
             "expected error, from 1° at the right to 90° at the left.");
}

std::string detection_section(const SubjectResult& subject) {
  const DataTable table = detection_table(subject);
  if (table.rows.empty()) return {};
  const DetectionPoint last = detection_of(subject).back();
  return html_figure(
      "Thresholds on the expected error", html_text(table, "results"),
      fmt::format("RCNN, every frame of all conditions: {} estimates, {} of them wrong. An estimate is "
                  "rejected when its expected error is above the threshold.",
                  last.wrong + last.right, last.wrong));
}

std::string sweeps_section(const Sweeps& sweeps) {
  return html_figure(
             "Hidden share", hidden_share_figure(sweeps),
             fmt::format(
                 "An arm, a mast or a panel edge in front of the target in every frame. {} sequences per "
                 "point. Bars: one standard error.",
                 sweeps.sweep_sequences)) +
         html_figure(fmt::format("Run of {} frames", sweeps.long_run.size()), long_run_figure(sweeps),
                     fmt::format("{} sequences, {}. The recurrent state must not drift.",
                                 sweeps.long_sequences, to_string(sweeps.base)));
}

std::string figures_of(const SubjectResult& subject) {
  const CellResult& base = subject.cells.front();
  const std::string condition = to_string(base.condition);
  const std::string rate_caption =
      subject.sweeps ? "Two ways to draw the rate, as in the paper: by its components (few slow sequences) "
                       "or by its norm."
                     : "The components of the rate are drawn, so that there are few slow sequences.";
  return "<div class=pair>\n" +
         html_figure("Error by condition", conditions_figure(subject), "Mean error of the last frame.") +
         html_figure("Error over the frames", frames_figure(subject),
                     fmt::format("Mean error of the RCNN by condition. Dashed: the CNN, {}.", condition)) +
         html_figure("Range", range_figure(base),
                     fmt::format("{}, last frame. Bars: one standard error.", condition)) +
         html_figure("Rate", rate_figure(subject), rate_caption + " Bars: one standard error.") +
         (subject.sweeps ? sweeps_section(*subject.sweeps) : std::string{}) +
         html_figure("Distribution of the error",
                     histogram_figure(base.rcnn_histogram, base.cnn_histogram, base.baseline_histogram),
                     fmt::format("{}, last frame.", condition)) +
         confusion_section(subject) + reliability_section(subject) + detection_section(subject) + "</div>\n";
}

std::string times_text(const CellResult& cell) {
  std::string text = fmt::format("step {:.2f} ms per frame", cell.step_ms);
  if (cell.baseline) text += fmt::format(", template matching {:.0f} ms", cell.baseline_ms);
  return text + " (median, one thread)";
}

std::string chapter(const Results& results, const SubjectResult& subject) {
  const CellResult& base = subject.cells.front();
  return fmt::format(
             "<h2 class=chapter>{}</h2>\n<p class=sub>model {}.tsm, CRC-32 <code>{:08x}</code>; seed {}; {} "
             "of {} "
             "({}); {}</p>\n",
             escape_markup(title_of(subject)), escape_markup(subject.model), subject.model_crc32,
             results.seed, counted(base.sequences, "sequence"), counted(base.frames, "frame"),
             to_string(base.condition), times_text(base)) +
         html_text(checks_table(subject), "results") + figures_of(subject);
}

// Among several subjects those with sweeps have a chapter; a single subject always has one.
bool has_chapter(const Results& results, const SubjectResult& subject) {
  return !subject.cells.empty() && (subject.sweeps.has_value() || results.subjects.size() == 1);
}

// Of the subjects that have one; all cells of a subject have the same.
std::string symmetries_of(const Results& results) {
  std::string text;
  for (const SubjectResult& subject : results.subjects) {
    if (subject.cells.empty() || subject.cells.front().symmetry.is_none()) continue;
    text += (text.empty() ? "" : "; ") + to_string(subject.cells.front().symmetry);
  }
  return text;
}

std::string notes_section(const std::vector<std::string>& notes) {
  std::string lines;
  for (const std::string& note : notes) lines += (lines.empty() ? "" : "<br>\n") + escape_markup(note);
  return lines.empty() ? lines : fmt::format("<div class=\"notice remark\">{}</div>\n", lines);
}

}  // namespace

std::string results_page(const Results& results) {
  std::string body = "<h1>Accuracy of attitude initialization</h1>\n";
  body += fmt::format("<p class=sub>Tumblesight, Monte Carlo evaluation, seed {}</p>\n<p class=lead>{}</p>\n",
                      results.seed, lead_sentence(results));
  const std::string symmetries = symmetries_of(results);
  if (!symmetries.empty())
    body += fmt::format("<p class=sub>Errors modulo the symmetry of the target: {}.</p>\n", symmetries);
  body += notes_section(results.notes);
  body += overview_section(results) + goals_section(results) + poses_section(results) +
          rare_events_section(results);
  for (const SubjectResult& subject : results.subjects) {
    if (has_chapter(results, subject)) body += chapter(results, subject);
  }
  body += fmt::format("<footer>{}<br><code>{}</code></footer>\n", escape_markup(results.generated),
                      escape_markup(results.command));
  return html_page("accuracy", body);
}

}  // namespace tumblesight::sim
