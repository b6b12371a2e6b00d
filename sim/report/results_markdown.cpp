#include <fmt/format.h>

#include <set>

#include "sim/evaluation/pose_goals.hpp"
#include "sim/report/results_files.hpp"
#include "sim/report/results_tables.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kReadingNotes = R"md(
- Error: the angle between true and estimated attitude in the last frame of a sequence. ± is one standard
  error: s/√n for a mean, binomial for a share. The binomial one is taken at (k + ½)/(n + 1), so that 100 % is
  not quoted as certain.
- `parametric` is the mesh that ships with this project. `<target>.stl` is a mesh from `--mesh-folder`: here
  NASA's display model of the spacecraft, which is not part of this project.
- RCNN: the recurrent network after all frames. CNN: the same network's estimate from the last frame alone.
  Templates: classical template matching with renderings of the same mesh as the frames, refined by iterative
  closest points (ICP), also from the last frame alone. It is slow and runs on the first sequences of each
  condition only.
- Training draws its frames from other seeds: no test sequence was seen in training or tuning.
- Paper: DOI 10.1016/j.conengprac.2026.107134. Goal: what this project demands of the registered pose.
- These figures decide whether the [requirements](requirements.csv) TS-EST-010 to TS-EST-090 are met: TS-EST-010,
  TS-EST-020 and TS-EST-030 by the poses in the tables of goals, TS-EST-040 and TS-EST-050 by the paper's figures,
  TS-EST-060, TS-EST-070 and TS-EST-080 by the checks of each spacecraft, TS-EST-090 by the tables on the detection
  of wrong estimates. Where a goal is higher than its requirement, the requirement says so.
)md";

std::string introduction(const Results& results) {
  std::string text = fmt::format(
      "# Results\n\nMade by\n\n```\n{}\n```\n\nwith seed {}. Every figure below comes from that run. Another "
      "run gives the same figures, except for the times.\nOn another kind of processor most agree to three "
      "digits, and a mean differs more\nwhere a sequence ends on [another attitude](cluster.md#by-hand).\n{}",
      results.command, results.seed, kReadingNotes);
  for (const std::string& note : results.notes) text += "- Note: " + note + "\n";
  return text + "\n";
}

std::string models_section(const Results& results) {
  DataTable table{{"model image", "CRC-32", "spacecraft"}, {}};
  std::set<std::string> listed;
  for (const SubjectResult& subject : results.subjects) {
    const std::string crc32 = fmt::format("`{:08x}`", subject.model_crc32);
    if (!listed.insert(subject.model + crc32 + subject.target).second) continue;
    table.rows.push_back({{"`" + subject.model + ".tsm`"}, {crc32}, {display_name(subject.target)}});
  }
  return "## Models\n\n" + markdown_text(table);
}

std::string accuracy_section(const Results& results) {
  std::string text = "## Accuracy of the RCNN, compared with the paper\n\n";
  for (const SubjectResult& subject : results.subjects) {
    text += fmt::format("### {}\n\n`{}.tsm`, CRC-32 `{:08x}`\n\n", title_of(subject), subject.model,
                        subject.model_crc32) +
            markdown_text(conditions_table({subject}, kAccuracyTable));
  }
  return text;
}

std::string others_section(const Results& results) {
  return "## Other estimators in the same run\n\nTimes: milliseconds per frame on one thread, median. A step "
         "is everything that flies: target selection, network and registration. It was measured while all "
         "cores evaluated; docs/numerics.md has times without other work.\n\n" +
         markdown_text(conditions_table(results.subjects, kOtherEstimatorsTable));
}

constexpr const char* kPoseNotes = R"md(## Registered pose

The pose that registration finds with the surface mesh in the model image. Errors of the last frame unless the first is
named. Across and along: of the origin of the target frame, perpendicular to the boresight and on it. Lengths and rates
are means over the poses within 20°; shares are of all sequences. Wrong: more than 5° off. Inside 95 %: share of the
verified poses whose attitude and position lie in the 95 % ellipsoid of their covariance.

)md";

// Nothing without poses.
std::string pose_sections(const Results& results) {
  std::string text;
  for (const SubjectResult& subject : results.subjects) {
    const DataTable table = poses_table(subject);
    if (!table.rows.empty()) text += "### " + title_of(subject) + "\n\n" + markdown_text(table);
  }
  return text.empty() ? text : kPoseNotes + text;
}

constexpr const char* kGoalNotes = R"md(## Goals: the paper's conditions and real sensors

What the registered pose reaches in the last frame, and whether the report knows it. The frames are nominal unless
stated otherwise; `tumblesight evaluate --effect list` explains the effects. Pose: mean error of those within 20°, and
the share of all sequences that is within 20°. Wrong and valid: the network's attitude is more than 20° off and the
report calls it valid; at most 1 % in each line. Valid of the right ones: at least 97 %, and 99.5 % under the paper's
conditions. Error below three times the expected one: at least 97 %. Mean expected error over mean real error: 0.7 to
1.5. Verified and wrong: more than 5° off. Frames of another object: at least 99.5 % of the sequences are never called
valid from the fifth frame on.

)md";

// TS-EST-194.
std::string pooled_text(const std::vector<SubjectResult>& subjects) {
  const WrongAndValid wrong = wrong_and_valid(subjects);
  const RightAndValid right = right_and_valid(subjects);
  return fmt::format(
             "**More than 20° off and valid, over all lines above but those of another object "
             "(TS-EST-194):** {} of {} last frames, "
             "{:.2f} %; goal: at most {:.1f} %, {}.\n\n",
             wrong.wrong, wrong.frames, 100.0 * wrong.share(), 100.0 * kMostWrongAndValid,
             wrong.share() <= kMostWrongAndValid ? "met" : "missed") +
         fmt::format(
             "**Valid of those within 20°, over the paper's conditions (TS-EST-194):** {} of {} last frames, "
             "{:.1f} %; goal: at least {:.0f} %, {}.\n\n",
             right.valid, right.right, 100.0 * right.share(), 100.0 * kLeastRightAndValid,
             right.share() >= kLeastRightAndValid ? "met" : "missed");
}

// Nothing without such runs.
std::string goals_section(const Results& results) {
  std::string text;
  for (const SubjectResult& subject : results.subjects) {
    const DataTable table = goals_table(subject);
    if (!table.rows.empty()) text += "### " + title_of(subject) + "\n\n" + markdown_text(table);
  }
  return text.empty() ? text : kGoalNotes + text + pooled_text(results.subjects);
}

constexpr const char* kDisturbedNotes = R"md(## Disturbed sequences

The options of `tumblesight evaluate --help` under the same names. Seed and sequences are those of the tables above, so
that a run with a disturbance and the run without it show the same targets, motions and noise. Valid: the attitude
passes the checks of the flight program; wrong: more than 20° off. Shares are of all sequences. The bars are those of
the requirements TS-EST-300, TS-EST-310, TS-EST-320 and TS-EST-330. They limit what a disturbance adds to the errors of
the network, on the same sequences without it. Pose: the registered one; verified, wrong: more than 5° off.

)md";

std::string disturbed_section(const SubjectResult& subject) {
  return fmt::format("### {}\n\n`{}.tsm`, CRC-32 `{:08x}`\n\n", title_of(subject), subject.model,
                     subject.model_crc32) +
         markdown_text(disturbed_table(subject));
}

// Nothing without disturbed runs.
std::string disturbed_sections(const Results& results) {
  std::string text;
  for (const SubjectResult& subject : results.subjects) {
    if (!subject.disturbed.empty()) text += disturbed_section(subject);
  }
  return text.empty() ? text : kDisturbedNotes + text;
}

// With its heading; nothing without points.
std::string curve_section(const std::string& heading, const std::string& at, const Curve& curve,
                          double scale = 1.0) {
  const DataTable table = curve_table(at, curve, scale);
  return table.rows.empty() ? std::string{} : "**" + heading + "**\n\n" + markdown_text(table);
}

// A selection of the frames of a long run.
Curve thinned(const Curve& curve) {
  Curve kept;
  for (const CurvePoint& point : curve) {
    const auto frame = static_cast<std::size_t>(point.at);
    if (frame == 1 || frame == 5 || frame == 10 || frame % 20 == 0) kept.push_back(point);
  }
  return kept;
}

std::string sweeps_section(const Sweeps& sweeps) {
  const std::string condition = to_string(sweeps.base);
  return curve_section("Rate, norm drawn, " + condition, "middle of the bin [°/s]", sweeps.by_rate_norm) +
         curve_section("Occluded, hidden share of the target's returns", "hidden [%]", sweeps.by_hidden_share,
                       100.0) +
         curve_section(fmt::format("A run of {} frames, {}", sweeps.long_run.size(), condition), "frame",
                       thinned(sweeps.long_run));
}

std::string confusion_section(const SubjectResult& subject) {
  return "**Share of each nearly symmetric attitude** (the target turned about z; within 20° of it; blur: "
         "mean error to the nearest of them)\n\n" +
         markdown_text(confusion_table(subject));
}

std::string reliability_section(const CellResult& cell) {
  return fmt::format(
             "**Expected and actual error of the RCNN, {}, every frame, in tenths sorted by the expected "
             "error**\n\n",
             to_string(cell.condition)) +
         markdown_text(reliability_table(cell));
}

std::string detection_section(const SubjectResult& subject) {
  const DataTable table = detection_table(subject);
  if (table.rows.empty()) return {};
  const DetectionPoint last = detection_of(subject).back();
  return fmt::format(
             "**Detection of wrong estimates.** All conditions, every frame: {} of {} estimates are more "
             "than 20° off. An estimate is rejected when its expected error is above a threshold:\n\n",
             last.wrong, last.wrong + last.right) +
         markdown_text(table);
}

std::string details_of(const SubjectResult& subject) {
  const CellResult& base = subject.cells.front();
  const std::string condition = to_string(base.condition);
  return "### " + title_of(subject) + "\n\n" + markdown_text(checks_table(subject)) +
         "**Mean error of the RCNN by frame**\n\n" + markdown_text(frames_table(subject)) +
         curve_section("Range, " + condition, "middle of the bin [m]", base.by_range) +
         curve_section("Rate, components drawn, " + condition, "middle of the bin [°/s]", base.by_rate) +
         (subject.sweeps ? sweeps_section(*subject.sweeps) : std::string{}) +
         fmt::format("**Distribution of the error, {}**\n\n", condition) +
         markdown_text(histogram_table(base)) + confusion_section(subject) + reliability_section(base) +
         detection_section(subject);
}

}  // namespace

std::string results_markdown(const Results& results) {
  std::string text = introduction(results) + models_section(results) + accuracy_section(results) +
                     goals_section(results) + others_section(results) + pose_sections(results) +
                     disturbed_sections(results);
  text += "## Curves, confusion, reliability\n\n";
  for (const SubjectResult& subject : results.subjects) {
    if (subject.sweeps && !subject.cells.empty()) text += details_of(subject);
  }
  text.pop_back();  // one newline at the end
  return text;
}

}  // namespace tumblesight::sim
