#include "sim/report/results_markdown.hpp"

#include <fmt/format.h>

#include "sim/evaluation/checks.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/report/results_table.hpp"

namespace tumblesight::sim {
namespace {

using Cells = std::vector<std::string>;

std::string line(const Cells& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cell + " |";
  return text + "\n";
}

// First column to the left, the others to the right.
std::string table(const Cells& header, const std::vector<Cells>& rows) {
  if (rows.empty()) return {};
  std::string text = line(header) + "|---|";
  for (std::size_t i = 1; i < header.size(); ++i) text += "---:|";
  text += "\n";
  for (const Cells& row : rows) text += line(row);
  return text + "\n";
}

std::string within_5deg_text(const ErrorSummary& summary) {
  return summary.count == 0 ? "-" : percent_text(summary.within_5deg, summary.count);
}

std::string verdict(const CellResult& cell, const std::optional<PaperFigure>& goal) {
  if (!goal) return "";
  return meets(cell.rcnn, *goal) ? "yes" : "**no**";
}

constexpr const char* kReadingNotes = R"md(
- Error: angle between true and estimated attitude in the last frame of a sequence. ± is one standard error: s/√n of
  a mean, binomial of a share (from (k + ½)/(n + 1), so that 100 % is not quoted as certain).
- `parametric` is the mesh that ships here; `<target>.stl` is a mesh from --mesh-folder, in the record NASA's display
  model of the spacecraft, which is not part of this project.
- RCNN: the recurrent network after all frames. CNN: the same network's estimate from the last frame alone. Template
  matching: the classical way, renderings of the same mesh as the frames', refined by iterated closest points, also
  from the last frame alone; on the first sequences of each cell only, since it takes so long.
- Training draws its frames from other seeds: none of the test sequences was seen in training or tuning.
- The paper: DOI 10.1016/j.conengprac.2026.107134. Goals: what this project set itself.
- Requirements that these figures show to be met: TS-EST-010, TS-EST-020, TS-EST-030, TS-EST-040, TS-EST-050,
  TS-EST-060, TS-EST-070, TS-EST-080, TS-EST-090 ([requirements](requirements.csv)).
)md";

std::string introduction(const Results& results) {
  std::string text = fmt::format(
      "# Results\n\nMade by\n\n```\n{}\n```\n\nwith seed {}. Every number below comes from that run; running "
      "it again "
      "gives the same ones, but for the times.\n{}",
      results.command, results.seed, kReadingNotes);
  for (const std::string& note : results.notes) text += "- Note: " + note + "\n";
  return text + "\n";
}

std::string models_section(const Results& results) {
  std::vector<Cells> rows;
  for (const SubjectResult& subject : results.subjects) {
    const Cells row{"`" + subject.model + ".tsm`", fmt::format("`{:08x}`", subject.model_crc32),
                    display_name(subject.target)};
    bool known = false;
    for (const Cells& other : rows) known = known || other == row;
    if (!known) rows.push_back(row);
  }
  return "## Models\n\n" + table({"model image", "CRC-32", "spacecraft"}, rows);
}

std::string accuracy_section(const Results& results) {
  std::string text = "## Accuracy of the RCNN beside the paper's\n\n";
  for (const SubjectResult& subject : results.subjects) {
    std::vector<Cells> rows;
    for (const CellResult& cell : subject.cells) {
      const PaperFigures paper = paper_figures(subject.target, cell.condition);
      rows.push_back({to_string(cell.condition), fmt::format("{}", cell.sequences),
                      "**" + mean_text(cell.rcnn) + "**", degrees_text(cell.rcnn.median_deg),
                      "**" + within_20deg_text(cell.rcnn) + "**", within_5deg_text(cell.rcnn),
                      figure_text(paper.rcnn), figure_text(paper.goal), verdict(cell, paper.goal)});
    }
    text +=
        fmt::format("### {}\n\n`{}.tsm`, CRC-32 `{:08x}`\n\n", title_of(subject), subject.model,
                    subject.model_crc32) +
        table({"condition", "sequences", "mean", "median", "≤ 20°", "≤ 5°", "the paper", "goal", "goal met"},
              rows);
  }
  return text;
}

std::string others_section(const Results& results) {
  std::vector<Cells> rows;
  for (const SubjectResult& subject : results.subjects) {
    for (const CellResult& cell : subject.cells) {
      const bool tried = cell.baseline.has_value();
      rows.push_back(
          {title_of(subject), to_string(cell.condition), mean_text(cell.cnn), within_20deg_text(cell.cnn),
           figure_text(paper_figures(subject.target, cell.condition).cnn),
           tried ? mean_text(*cell.baseline) : "-", tried ? within_20deg_text(*cell.baseline) : "-",
           tried ? fmt::format("{}", cell.baseline->count) : "-", fmt::format("{:.2f}", cell.network_ms),
           tried ? fmt::format("{:.0f}", cell.baseline_ms) : "-"});
    }
  }
  return "## Other estimators in the same run\n\nTimes: milliseconds a frame on one thread, median; the "
         "network's "
         "covers CNN and RCNN together.\n\n" +
         table({"spacecraft, mesh", "condition", "CNN", "≤ 20°", "the paper's CNN", "template matching",
                "≤ 20°", "on sequences", "network ms", "template ms"},
               rows);
}

std::string curve_table(const std::string& heading, const std::string& at, const Curve& curve,
                        double scale = 1.0) {
  std::vector<Cells> rows;
  for (const CurvePoint& point : curve) {
    if (point.rcnn.count == 0) continue;
    rows.push_back({fmt::format("{:g}", scale * point.at), fmt::format("{}", point.rcnn.count),
                    mean_text(point.rcnn), within_20deg_text(point.rcnn), mean_text(point.cnn)});
  }
  if (rows.empty()) return {};
  return "**" + heading + "**\n\n" + table({at, "sequences", "RCNN", "≤ 20°", "CNN"}, rows);
}

// Of a long run a selection.
Curve thinned(const Curve& curve) {
  Curve kept;
  for (const CurvePoint& point : curve) {
    const auto frame = static_cast<std::size_t>(point.at);
    if (frame == 1 || frame == 5 || frame == 10 || frame % 20 == 0) kept.push_back(point);
  }
  return kept;
}

std::string frames_table(const SubjectResult& subject) {
  Cells header{"frame"};
  for (const CellResult& cell : subject.cells) header.push_back(to_string(cell.condition));
  std::vector<Cells> rows;
  for (std::size_t frame = 0; frame < subject.cells.front().by_frame.size(); ++frame) {
    Cells row{fmt::format("{}", frame + 1)};
    for (const CellResult& cell : subject.cells)
      row.push_back(degrees_text(cell.by_frame[frame].rcnn.mean_deg));
    rows.push_back(row);
  }
  return "**Mean error of the RCNN by frame**\n\n" + table(header, rows);
}

std::string histogram_table(const CellResult& cell) {
  const std::vector<double>& limits = histogram_limits_deg();
  std::vector<Cells> rows;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    rows.push_back({fmt::format("{:g}–{:g}°", i == 0 ? 0.0 : limits[i - 1], limits[i]),
                    percent_text(cell.rcnn_histogram[i]), percent_text(cell.cnn_histogram[i]),
                    cell.baseline_histogram.empty() ? "-" : percent_text(cell.baseline_histogram[i])});
  }
  return fmt::format("**Distribution of the error, {}**\n\n", to_string(cell.condition)) +
         table({"error", "RCNN", "CNN", "template matching"}, rows);
}

std::string confusion_table(const SubjectResult& subject) {
  Cells header{"condition"};
  for (const std::string& name : subject.cells.front().rcnn_confusion.names) header.push_back(name);
  for (const char* name : {"none of these", "blur", "CNN right", "CNN blur"}) header.emplace_back(name);
  std::vector<Cells> rows;
  for (const CellResult& cell : subject.cells) {
    Cells row{to_string(cell.condition)};
    for (const double share : cell.rcnn_confusion.shares) row.push_back(percent_text(share));
    row.push_back(percent_text(cell.rcnn_confusion.none));
    row.push_back(degrees_text(cell.rcnn_confusion.blur_deg, cell.rcnn_confusion.blur_standard_error_deg));
    row.push_back(percent_text(cell.cnn_confusion.shares.front()));
    row.push_back(degrees_text(cell.cnn_confusion.blur_deg, cell.cnn_confusion.blur_standard_error_deg));
    rows.push_back(row);
  }
  return "**Which of the nearly symmetric attitudes** (turned about z; within 20° of it; blur: mean error to "
         "the nearest of "
         "them)\n\n" +
         table(header, rows);
}

std::string reliability_table(const CellResult& cell) {
  std::vector<Cells> rows;
  for (const ReliabilityBin& bin : cell.reliability) {
    rows.push_back({degrees_text(bin.predicted_deg), degrees_text(bin.real.mean_deg),
                    degrees_text(bin.real.median_deg), fmt::format("{}", bin.real.count)});
  }
  return fmt::format(
             "**Predicted and real error of the RCNN, {}, every frame, in tenths by the predicted "
             "error**\n\n",
             to_string(cell.condition)) +
         table({"predicted", "real, mean", "real, median", "frames"}, rows);
}

std::string detection_table(const SubjectResult& subject) {
  std::vector<Cells> rows;
  std::size_t wrong = 0;
  std::size_t all = 0;
  for (const DetectionPoint& point : detection_of(subject)) {
    wrong = point.wrong;
    all = point.wrong + point.right;
    rows.push_back({fmt::format("{:g}°", point.threshold_deg), percent_text(point.detected()),
                    percent_text(point.false_alarms()),
                    fmt::format("{:.2f} %", 100.0 * point.wrong_among_kept())});
  }
  return fmt::format(
             "**Does it know when it is wrong?** All conditions, every frame: {} of {} estimates are more "
             "than "
             "20° off. Thrown away when the predicted error is above a threshold:\n\n",
             wrong, all) +
         table({"threshold", "wrong ones thrown away", "right ones thrown away", "wrong among the kept"},
               rows);
}

std::string checks_table(const SubjectResult& subject) {
  std::vector<Cells> rows;
  for (const Check& check : checks_of(subject)) {
    rows.push_back({check.what, text_of(check), check.holds() ? "yes" : "**no**"});
  }
  return table({"check", "value and limit", "holds"}, rows);
}

std::string details_of(const SubjectResult& subject) {
  const CellResult& base = subject.cells.front();
  const std::string condition = to_string(base.condition);
  std::string text =
      "### " + title_of(subject) + "\n\n" + checks_table(subject) + frames_table(subject) +
      curve_table("Range, " + condition, "middle of the bin [m]", base.by_range) +
      curve_table("Rate, components drawn, " + condition, "middle of the bin [°/s]", base.by_rate);
  if (subject.sweeps) {
    const Sweeps& sweeps = *subject.sweeps;
    text += curve_table("Rate, norm drawn, " + to_string(sweeps.base), "middle of the bin [°/s]",
                        sweeps.by_rate_norm) +
            curve_table("Occluded, hidden share of the target's returns", "hidden [%]",
                        sweeps.by_hidden_share, 100.0) +
            curve_table(fmt::format("A run of {} frames, {}", sweeps.long_run.size(), to_string(sweeps.base)),
                        "frame", thinned(sweeps.long_run));
  }
  return text + histogram_table(base) + confusion_table(subject) + reliability_table(base) +
         detection_table(subject);
}

}  // namespace

std::string results_markdown(const Results& results) {
  std::string text =
      introduction(results) + models_section(results) + accuracy_section(results) + others_section(results);
  text += "## Curves, confusion, reliability\n\n";
  for (const SubjectResult& subject : results.subjects) {
    if (subject.sweeps && !subject.cells.empty()) text += details_of(subject);
  }
  text.pop_back();  // one newline at the end
  return text;
}

}  // namespace tumblesight::sim
