#include "sim/report/results_report.hpp"

#include <fmt/format.h>

#include "sim/evaluation/checks.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/report/error_figures.hpp"
#include "sim/report/page.hpp"
#include "sim/report/palette.hpp"
#include "sim/report/results_figures.hpp"
#include "sim/report/results_table.hpp"
#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

using Cells = std::vector<std::string>;

constexpr const char* kNothing = "<span class=quiet>–</span>";

std::string or_nothing(const std::string& text) {
  return text == "-" ? kNothing : text;
}

// A goal beside our figure is coloured by whether it is met.
std::string goal_cell(const CellResult& cell, const std::optional<PaperFigure>& goal) {
  if (!goal) return kNothing;
  return fmt::format("<span class={}>{}</span>", meets(cell.rcnn, *goal) ? "met" : "missed",
                     figure_text(goal));
}

Cells overview_row(const SubjectResult& subject, const CellResult& cell) {
  const PaperFigures paper = paper_figures(subject.target, cell.condition);
  return {to_string(cell.condition),
          fmt::format("<b class=rcnn>{}</b>", mean_text(cell.rcnn)),
          within_20deg_text(cell.rcnn),
          or_nothing(figure_text(paper.rcnn)),
          goal_cell(cell, paper.goal),
          mean_text(cell.cnn),
          within_20deg_text(cell.cnn),
          cell.baseline ? mean_text(*cell.baseline) : kNothing,
          cell.baseline ? within_20deg_text(*cell.baseline) : kNothing};
}

std::string overview_section(const Results& results) {
  HtmlTable table;
  table.css_class = "results";
  table.header = {"last frame", "RCNN", "≤ 20°", "the paper", "goal", "CNN", "≤ 20°", "templates", "≤ 20°"};
  for (const SubjectResult& subject : results.subjects) {
    table.rows.push_back({escape_markup(title_of(subject))});
    for (const CellResult& cell : subject.cells) table.rows.push_back(overview_row(subject, cell));
  }
  return html_table(table) +
         "<p class=sub>Mean angular error ± one standard error, and the share within 20°. RCNN: after all "
         "frames. CNN: "
         "from the last frame alone. Templates: renderings of the same mesh matched to the last frame and "
         "refined by "
         "iterated closest points, on the first sequences of each cell. Goals: <span class=met>met</span>, "
         "<span class=missed>missed</span>.</p>\n";
}

// Of one network on one mesh: its error under each condition.
std::string lead_of(const SubjectResult& subject) {
  std::string errors;
  for (const CellResult& cell : subject.cells) {
    errors +=
        fmt::format("{}{} ({})", errors.empty() ? "" : ", ", mean_text(cell.rcnn), to_string(cell.condition));
  }
  return fmt::format("After {} frames the attitude of {} is known to {} on average.",
                     subject.cells.front().frames, escape_markup(display_name(subject.target)), errors);
}

// Of many: how they stand against the paper and the goals.
std::string lead_of(const std::vector<SubjectResult>& subjects) {
  std::size_t published = 0;
  std::size_t beaten = 0;
  std::size_t met = 0;
  for (const SubjectResult& subject : subjects) {
    for (const CellResult& cell : subject.cells) {
      const PaperFigures paper = paper_figures(subject.target, cell.condition);
      if (!paper.rcnn || !paper.goal) continue;
      ++published;
      if (cell.rcnn.mean_deg < paper.rcnn->mean_deg) ++beaten;
      if (meets(cell.rcnn, *paper.goal)) ++met;
    }
  }
  return fmt::format(
      "For {} of the cells below the paper published a figure. In {} of them the mean error here is "
      "smaller; {} meet the goal that this project set itself.",
      published, beaten, met);
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
      "Which attitude was taken", confusion_figure(rows),
      "RCNN, last frame: share within 20° of the true attitude (right) or of that turned about z, where the "
      "target looks "
      "nearly the same. Blur: mean error to the nearest of them, what is left without confusion.");
}

std::string reliability_section(const SubjectResult& subject) {
  std::vector<Named<std::vector<ReliabilityBin>>> lines;
  for (const CellResult& cell : subject.cells) {
    lines.push_back({to_string(cell.condition), colour_of(cell.condition), cell.reliability});
  }
  return html_figure("Does it know how good it is?", reliability_figure(lines),
                     "RCNN, every frame, in tenths by the predicted error. On the dashed line the prediction "
                     "is right on "
                     "average; above it the network is too sure of itself.") +
         html_figure(
             "Does it know when it is wrong?", detection_figure(detection_of(subject)),
             "RCNN, every frame of all conditions; wrong: more than 20° off. Each mark is a threshold on the "
             "predicted error, 1° at the right to 90° at the left.");
}

std::string detection_section(const SubjectResult& subject) {
  HtmlTable table;
  table.css_class = "results";
  table.header = {"threshold", "wrong flagged", "right flagged", "wrong among the rest"};
  std::size_t wrong = 0;
  std::size_t right = 0;
  for (const DetectionPoint& point : detection_of(subject)) {
    wrong = point.wrong;
    right = point.right;
    table.rows.push_back({fmt::format("{:g}°", point.threshold_deg), percent_text(point.detected()),
                          percent_text(point.false_alarms()),
                          fmt::format("{:.2f} %", 100.0 * point.wrong_among_kept())});
  }
  if (table.rows.empty()) return {};
  return html_figure("What a threshold on the predicted error does", html_table(table),
                     fmt::format("RCNN, every frame of all conditions: {} estimates, {} of them wrong.",
                                 wrong + right, wrong));
}

std::string sweeps_section(const Sweeps& sweeps) {
  return html_figure(
             "Hidden share", hidden_share_figure(sweeps),
             fmt::format(
                 "Arm, mast or panel edge over the target in every frame; {} sequences a point. Bars: one "
                 "standard error.",
                 sweeps.sweep_sequences)) +
         html_figure(fmt::format("{} frames", sweeps.long_run.size()), long_run_figure(sweeps),
                     fmt::format("{} sequences, {}: the state must not drift.", sweeps.long_sequences,
                                 to_string(sweeps.base)));
}

std::string checks_section(const SubjectResult& subject) {
  HtmlTable table;
  table.css_class = "results";
  table.header = {"required", "value and limit", "holds"};
  for (const Check& check : checks_of(subject)) {
    table.rows.push_back({escape_markup(check.what), text_of(check),
                          check.holds() ? "<span class=met>yes</span>" : "<span class=missed>no</span>"});
  }
  return table.rows.empty() ? std::string{} : html_table(table);
}

std::string figures_of(const SubjectResult& subject) {
  const CellResult& base = subject.cells.front();
  const std::string condition = to_string(base.condition);
  const std::string rate_caption =
      subject.sweeps
          ? "Two ways of drawing the rate, as in the paper: its components (few slow sequences) or its norm."
          : "The components of the rate are drawn, so there are few slow sequences.";
  return "<div class=pair>\n" +
         html_figure("Error by condition", conditions_figure(subject), "Mean error of the last frame.") +
         html_figure("Error over the frames", frames_figure(subject),
                     fmt::format("RCNN by condition; dashed: the CNN, {}.", condition)) +
         html_figure("Range", range_figure(base),
                     fmt::format("{}, last frame, bars: one standard error.", condition)) +
         html_figure("Rate", rate_figure(subject), rate_caption + " Bars: one standard error.") +
         (subject.sweeps ? sweeps_section(*subject.sweeps) : std::string{}) +
         html_figure("Distribution of the error",
                     histogram_figure(base.rcnn_histogram, base.cnn_histogram, base.baseline_histogram),
                     fmt::format("{}, last frame.", condition)) +
         confusion_section(subject) + reliability_section(subject) + detection_section(subject) + "</div>\n";
}

std::string times_text(const CellResult& cell) {
  std::string text = fmt::format("network {:.2f} ms a frame", cell.network_ms);
  if (cell.baseline) text += fmt::format(", template matching {:.0f} ms", cell.baseline_ms);
  return text + " (median, one thread)";
}

std::string chapter(const Results& results, const SubjectResult& subject) {
  const CellResult& base = subject.cells.front();
  return fmt::format(
             "<h2 class=chapter>{}</h2>\n<p class=sub>model {}.tsm, CRC-32 <code>{:08x}</code>; seed {}; {} "
             "sequences of {} frames ({}); {}</p>\n",
             escape_markup(title_of(subject)), escape_markup(subject.model), subject.model_crc32,
             results.seed, base.sequences, base.frames, to_string(base.condition), times_text(base)) +
         checks_section(subject) + figures_of(subject);
}

// With more than one subject a chapter each for those with curves, else for the only one.
bool has_chapter(const Results& results, const SubjectResult& subject) {
  return !subject.cells.empty() && (subject.sweeps.has_value() || results.subjects.size() == 1);
}

std::string notes_section(const std::vector<std::string>& notes) {
  std::string lines;
  for (const std::string& note : notes) lines += (lines.empty() ? "" : "<br>\n") + escape_markup(note);
  return lines.empty() ? lines : fmt::format("<div class=\"notice remark\">{}</div>\n", lines);
}

}  // namespace

std::string results_report(const Results& results) {
  std::string body = "<h1>Accuracy of attitude initialisation</h1>\n";
  body += fmt::format("<p class=sub>Tumblesight, Monte Carlo evaluation, seed {}</p>\n<p class=lead>{}</p>\n",
                      results.seed, lead_sentence(results));
  body += notes_section(results.notes);
  body += overview_section(results);
  for (const SubjectResult& subject : results.subjects) {
    if (has_chapter(results, subject)) body += chapter(results, subject);
  }
  body += fmt::format("<footer>{}<br><code>{}</code></footer>\n", escape_markup(results.generated),
                      escape_markup(results.command));
  return html_page("accuracy", body);
}

}  // namespace tumblesight::sim
