#include "sim/report/run_page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "sim/report/charts.hpp"
#include "sim/report/svg.hpp"
#include "tests/unit/sim/report/markup_checks.hpp"

namespace tumblesight::sim {
namespace {

RunReport small_report() {
  RunReport report;
  report.setup.target = "near_shoemaker";
  report.setup.condition = "nominal";
  report.setup.sequences = 3;
  report.setup.frames = 4;
  report.frame_period_s = 2.7;
  report.steps_planned = 12;
  report.trace_crc32 = 0xDEADBEEF;
  report.paper = paper_figures(report.setup.target, Condition::kNominal);
  for (std::uint32_t i = 0; i < 12; ++i) {
    FrameResult result;
    result.sequence = i / 4;
    result.frame = i % 4;
    result.valid = i != 5;
    result.rcnn = Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
    result.cnn = Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
    result.rcnn_predicted_rad = 0.08;
    report.results.push_back(result);
    ReportPicture picture{result.sequence, result.frame, 42.0, {}};
    picture.image.depth[5000 + i] = 32768;
    report.pictures.push_back(picture);
  }
  report.facts = {{"Settings", {{"seed", "17"}, {"<odd> & \"name\"", "it's"}}}};
  return report;
}

TEST(RunPage, ShowsTheFiguresBesideThePapers) {
  const std::string html = run_page(small_report());
  EXPECT_NE(html.find("5.73°"), std::string::npos);   // 0.1 rad
  EXPECT_NE(html.find("22.92°"), std::string::npos);  // 0.4 rad
  EXPECT_NE(html.find("12.69°"), std::string::npos);
  EXPECT_NE(html.find("40.94°"), std::string::npos);
  EXPECT_NE(html.find("&lt;odd&gt; &amp; &quot;name&quot;"), std::string::npos);
}

TEST(RunPage, ShowsThePeriodOfTheSensorAsItWasGiven) {
  RunReport report = small_report();
  report.frame_period_s = 0.25;
  const std::string html = run_page(report);
  EXPECT_NE(html.find("4 frames, 0.25 s apart"), std::string::npos);
  EXPECT_NE(html.find("one every 0.25 s"), std::string::npos);
}

TEST(RunPage, HoldsWellFormedFigures) {
  const std::vector<std::string> svgs = svgs_of(run_page(small_report()));
  EXPECT_EQ(svgs.size(), 6U);
  for (const std::string& svg : svgs) {
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

TEST(RunPage, NeedsNothingButItself) {
  EXPECT_EQ(outside_reference(run_page(small_report())), "");
}

TEST(RunPage, OfARunThatWasRecordedSaysHowToStepThroughIt) {
  RunReport report = small_report();
  EXPECT_EQ(run_page(report).find("tumblesight console"), std::string::npos);
  report.recording = "/out/<run>.mcap";
  EXPECT_NE(run_page(report).find("<code>tumblesight console /out/&lt;run&gt;.mcap</code>"),
            std::string::npos);
}

TEST(RunPage, OfARunThatEndedEarlySaysSo) {
  RunReport report = small_report();
  report.steps_missed = 12;
  report.results.clear();
  report.pictures.clear();
  report.notices = {"The run ended early: flight program gone."};
  const std::string html = run_page(report);
  EXPECT_NE(html.find("flight program gone"), std::string::npos);
  EXPECT_NE(html.find("No sequence was answered completely"), std::string::npos);
}

TEST(RunPage, DrawsASequenceThatBrokeOff) {
  RunReport report = small_report();
  report.results.resize(2);
  for (const std::string& svg : svgs_of(run_page(report))) EXPECT_EQ(xml_fault(svg), "");
}

TEST(XmlFault, FindsWhatItIsFor) {
  EXPECT_NE(xml_fault("<svg><g></svg></g>"), "");
  EXPECT_NE(xml_fault("<svg><text>a < b</text></svg>"), "");
  EXPECT_NE(xml_fault("<svg><line x1=3/></svg>"), "");
  EXPECT_EQ(xml_fault("<svg a=\"1\"><line x=\"3\"/></svg>"), "");
}

TEST(RoundTicks, CoverTheRangeInRoundSteps) {
  EXPECT_EQ(round_ticks(0.0, 43.0, 5), (std::vector<double>{0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(round_ticks(-1.0, 1.0, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_EQ(round_ticks(3.0, 3.0, 4), (std::vector<double>{3}));
}

}  // namespace
}  // namespace tumblesight::sim
