#include "sim/report/replay_report.hpp"

#include <gtest/gtest.h>

#include "sim/report/sil_report.hpp"
#include "tests/unit/sim/report/markup_checks.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::int64_t kPeriod = kFramePeriod_ns;

// Two tracks of two frames, 0.1 rad off, and between them two cycles without a frame and a refused frame.
SilRunResult run() {
  SilRunResult made;
  for (std::uint32_t k = 0; k < 7; ++k) {
    StepResult step;
    step.time_ns = k * kPeriod;
    step.truth = {Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), 50.0};
    step.answered = true;
    step.attitude.frames_since_reset = 1 + (k < 2 ? k : k - 5);
    step.attitude.q_lrf_trf = {1072399895, 53664725, 0, 0};
    step.attitude.predicted_error_urad = 17453;
    step.attitude.centroid_lrf_mm = {0, 30'000, 40'000};
    step.telemetry.mode = hal::Mode::kRun;
    made.steps.push_back(step);
  }
  for (const std::size_t k : {2U, 3U, 4U})
    made.steps[k].attitude.validity = k == 4 ? hal::Validity::kFrameRefused : hal::Validity::kNoFrame;
  for (std::size_t k = 4; k < 7; ++k) made.steps[k].telemetry.frames_bad = 1;
  made.steps[4].events = {{0, hal::EventId::kFrameBad, hal::Severity::kWarning, {2, 3, 128}}};
  made.steps[6].attitude.validity = hal::Validity::kDoubtful;
  made.steps[6].attitude.doubts = hal::kDoubtErrorLarge | hal::kDoubtAttitudeJump | hal::kDoubtUnexplained;
  made.steps_planned = 7;
  return made;
}

ReplayReport report_of(SilRunResult& run, const char* truth) {
  std::vector<ReplayedFrame> frames;
  for (StepResult& step : run.steps) {
    step.truth_known = *truth != '\0';
    const auto number = static_cast<std::uint32_t>(frames.size());
    if (step.attitude.validity != hal::Validity::kNoFrame)
      frames.push_back({step.time_ns, {number, step.time_ns}, 1000 + number});
  }
  ReplaySetup setup;
  setup.recording = "folder/<frames>.tslr";
  setup.truth = truth;
  setup.target = "near_shoemaker";
  setup.projection = {7000, 3800};
  setup.frames = static_cast<std::uint32_t>(frames.size());
  return replay_report(setup, run, frames);
}

// Verifies TS-SIL-140.
TEST(ReplayReport, HasARowPerCycleAndOneForAGapInTheTable) {
  SilRunResult made = run();
  const ReplayReport report = report_of(made, "a.csv");
  ASSERT_EQ(report.rows.size(), 7U);
  EXPECT_EQ(report.rows[4].status, "refused: too few returns");
  EXPECT_EQ(report.rows[6].status, "doubtful: expected error, jump, not explained by the target");
  EXPECT_EQ(report.rows[5].frame->stamp.sequence_number, 3U);
  EXPECT_FALSE(report.rows[3].frame.has_value());
  const DataTable table = replay_table(report);
  ASSERT_EQ(table.rows.size(), 6U);
  EXPECT_EQ(table.rows[2][0].text, "2…3");
  EXPECT_EQ(table.rows[2][4].text, "no frame, 2 cycles");
  EXPECT_EQ(table.rows[0][5].text, "50.0 m");
  EXPECT_EQ(table.rows[0][7].text, "1.00°");
  EXPECT_EQ(table.rows[0][8].text, "5.73°");
  EXPECT_EQ(replay_table(report_of(made, "")).rows[0].size(), 8U) << "no error without truth";
}

TEST(ReplayReport, TakesTracksAsSequencesAndScoresAttitudesOnly) {
  SilRunResult made = run();
  made.steps[0].answered = false;
  const ReplayReport report = report_of(made, "a.csv");
  EXPECT_EQ(report.rows.size(), 6U);
  ASSERT_EQ(report.run.results.size(), 3U);
  EXPECT_EQ(report.run.results[0].frame, 1U);
  EXPECT_EQ(report.run.results[2].sequence, 1U);
  const DataTable errors = replay_errors_table(report);
  EXPECT_EQ(errors.rows[0].back().text, "2");
  EXPECT_EQ(errors.rows[1].back().text, "3");
  EXPECT_EQ(errors.rows[1][1].text, "5.73°");
}

TEST(ReplayReport, PicturesFramesWithAnAttitudeByTheirTrack) {
  SilRunResult made = run();
  gnc::RangeImage frame;
  frame.rays = 128;
  frame.fov_urad = 140'000;
  for (int i = 0; i < 400; ++i) frame.ranges[8000 + i] = static_cast<std::uint16_t>(6400 + i % 7);
  made.pictures = {{4, frame}, {6, frame}};
  const ReplayReport report = report_of(made, "");
  ASSERT_EQ(report.run.pictures.size(), 1U) << "the other was refused";
  EXPECT_EQ(report.run.pictures[0].sequence, 1U);
  EXPECT_EQ(report.run.pictures[0].frame, 1U);
  EXPECT_EQ(report.run.pictures[0].range_m, 50.0);
}

TEST(ReplayReport, NamesTheKindOfARefusalWhoseEventWasSuppressed) {
  SilRunResult made = run();
  made.steps[4].events.clear();
  EXPECT_EQ(report_of(made, "").rows[4].status, "refused: bad");
}

SilRunResult run_of_bad_frames(ReplayedFrame& frame) {
  SilRunResult made = run();
  made.steps = {made.steps[4]};
  frame.cycle_time_ns = made.steps[0].time_ns;
  return made;
}

TEST(ReplayReport, NamesTheReturnsThatAFrameWithTooFewLacks) {
  ReplayedFrame frame;
  frame.returns = frame.nearer = 1681;
  const SilRunResult made = run_of_bad_frames(frame);
  EXPECT_EQ(replay_report({}, made, {frame}).rows[0].status,
            "refused: too few returns, 1681 nearer than 10 m left out");
  frame.nearer = 0;
  frame.farther = 7;
  EXPECT_EQ(replay_report({}, made, {frame}).rows[0].status,
            "refused: too few returns, 7 beyond 500 m left out");
}

// Other axes, units or angles than the recording's leave no frame that can be used.
TEST(ReplayReport, SaysWhatIsLikelyIfNoFrameIsAccepted) {
  ReplayedFrame frame;
  frame.returns = frame.nearer = 1681;
  const SilRunResult made = run_of_bad_frames(frame);
  ReplayReport report = replay_report({}, made, {frame});
  const std::string text = nothing_accepted_text(report);
  for (const char* part : {"No frame of the recording was accepted", "axes", "in ROS, x is forward",
                           "radians", "metres", "nearer than 10 m"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_NE(replay_page(report).find("No frame of the recording was accepted"), std::string::npos);
  report.setup.shows_target = false;
  EXPECT_EQ(nothing_accepted_text(report), "");
  SilRunResult other = run();
  EXPECT_EQ(nothing_accepted_text(report_of(other, "")), "") << "some frames have attitudes";
}

// Verifies TS-SIL-380.
TEST(ReplayReport, SaysThatMostOfItsAttitudesAreWrong) {
  SilRunResult made = run();
  EXPECT_EQ(mostly_wrong_text(report_of(made, "a.csv")), "");
  for (StepResult& step : made.steps) step.attitude.q_lrf_trf = {0, 1 << 30, 0, 0};
  EXPECT_EQ(mostly_wrong_text(report_of(made, "")), "") << "the truth is not known";
  ReplayReport report = report_of(made, "a.csv");
  EXPECT_EQ(mostly_wrong_text(report),
            "100 % of the attitudes are more than 20° off, and their mean error of 180.0° is of no use.");
  EXPECT_NE(replay_page(report).find("<p class=lead>The network does not know the attitude"),
            std::string::npos);
  report.setup.shows_target = false;
  EXPECT_EQ(mostly_wrong_text(report), "");
  EXPECT_EQ(replay_page(report).find("does not know"), std::string::npos);
}

TEST(ReplayPage, IsWellFormedWithTruthWithoutItAndWithoutAnswers) {
  for (const char* const truth : {"a.csv", ""}) {
    for (const bool answered : {true, false}) {
      SilRunResult made = run();
      for (StepResult& step : made.steps) step.answered = answered;
      const std::string html = replay_page(report_of(made, truth));
      EXPECT_EQ(outside_reference(html), "");
      EXPECT_NE(html.find("&lt;frames&gt;.tslr"), std::string::npos);
      for (const std::string& svg : svgs_of(html)) EXPECT_EQ(xml_fault(svg), "");
    }
  }
}

}  // namespace
}  // namespace tumblesight::sim
