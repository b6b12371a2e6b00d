// What results are compared with: the paper's figures and the goals, further checks, the figures of a shipped
// model.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/evaluation/checks.hpp"
#include "sim/experiment/shipped_figures.hpp"
#include "sim/report/results_json.hpp"
#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

ErrorSummary summary(std::size_t count, double mean_deg, double error_deg, double within_20deg) {
  ErrorSummary made;
  made.count = count;
  made.mean_deg = mean_deg;
  made.mean_standard_error_deg = error_deg;
  made.within_20deg = within_20deg;
  return made;
}

TEST(PaperFigures, CoverThePapersConditions) {
  for (const char* target : {"near_shoemaker", "magellan", "sacd_aquarius", "sacd_aquarius_stowed"}) {
    for (const Condition condition :
         {Condition::kNominal, Condition::kDegraded, Condition::kOccluded, Condition::kTumbling}) {
      EXPECT_TRUE(paper_figures(target, condition).rcnn.has_value()) << target << " " << to_string(condition);
      EXPECT_EQ(paper_figures(target, condition).cnn.has_value(), condition == Condition::kNominal);
    }
  }
  EXPECT_DOUBLE_EQ(paper_figures("near_shoemaker", Condition::kStress).rcnn->mean_deg, 17.21);
  EXPECT_FALSE(paper_figures("magellan", Condition::kStress).rcnn.has_value());
  EXPECT_FALSE(paper_figures("mine", Condition::kNominal).rcnn.has_value());
  EXPECT_EQ(paper_figures("magellan", Condition::kTumbling).sequences, 1000U);
}

TEST(Checks, MeasureTheCostOfAnOffset) {
  SubjectResult subject;
  subject.cells.resize(2);
  subject.cells[0].rcnn = summary(900, 2.0, 0.1, 1.0);
  subject.cells[1].condition = Condition::kOffset;
  subject.cells[1].rcnn = summary(900, 2.3, 0.1, 1.0);
  const std::vector<Check> checks = checks_of(subject);
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_NEAR(checks[0].value, 15.0, 1e-9);
  EXPECT_FALSE(checks[0].holds());
  EXPECT_EQ(text_of(checks[0]), "15.0 %, at most 10 %");
}

// 3 degrees in the second half of the run, 2 degrees in the tenth frame.
TEST(Checks, FindDriftInALongRun) {
  SubjectResult subject;
  subject.sweeps.emplace();
  for (int frame = 1; frame <= 100; ++frame) {
    const double mean_deg = frame > 50 ? 3.0 : 2.0;
    subject.sweeps->long_run.push_back({static_cast<double>(frame), summary(100, mean_deg, 0.1, 1.0), {}});
  }
  const std::vector<Check> checks = checks_of(subject);
  ASSERT_EQ(checks.size(), 1U);
  EXPECT_DOUBLE_EQ(checks[0].value, 1.5);
  EXPECT_FALSE(checks[0].holds());
}

TEST(ShippedFigures, AreReadBackFromTheJsonOfAnEvaluation) {
  const std::vector<ShippedFigures> rows =
      read_shipped_figures(results_json(sample_results()).dump(), "some.json");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].target, "near_shoemaker");
  EXPECT_EQ(rows[1].condition, Condition::kOccluded);
  EXPECT_EQ(rows[1].model_crc32, 0x00C0FFEEU);
  EXPECT_EQ(rows[1].frames, 2U);
  EXPECT_EQ(rows[1].seed, 7U);
  const CellResult cell = sample_cell(Condition::kOccluded, 15.0, true);
  EXPECT_EQ(rows[1].rcnn.count, 40U);
  EXPECT_DOUBLE_EQ(rows[1].rcnn.mean_deg, cell.rcnn.mean_deg);
  EXPECT_DOUBLE_EQ(rows[1].rcnn.mean_standard_error_deg, cell.rcnn.mean_standard_error_deg);
  EXPECT_DOUBLE_EQ(rows[1].cnn.within_20deg, cell.cnn.within_20deg);
}

TEST(ShippedFigures, ADamagedFileIsNamed) {
  for (const char* text : {"", "{}", R"({"rows":[{"target":"x"}]})"}) {
    try {
      read_shipped_figures(text, "fsw/models/x.json");
      FAIL() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("fsw/models/x.json"), std::string::npos);
    }
  }
}

// Numbers outside the range of their field and malformed CRCs.
TEST(ShippedFigures, AnImpossibleNumberIsRefused) {
  const std::string good = results_json(sample_results()).dump();
  const std::pair<const char*, const char*> changes[] = {
      {R"("frames":2)", R"("frames":-1)"},         {R"("frames":2)", R"("frames":1e30)"},
      {R"("frames":2)", R"("frames":4294967296)"}, {R"("seed":7)", R"("seed":0.5)"},
      {R"("00c0ffee")", R"("-1c0ffee")"},          {R"("00c0ffee")", R"("c0ffee")"},
      {R"("00c0ffee")", R"("100c0ffee")"}};
  for (const auto& [from, to] : changes) {
    std::string text = good;
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), std::string(from).size(), to);
    try {
      read_shipped_figures(text, "some.json");
      FAIL() << to;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("must be"), std::string::npos) << error.what();
    }
  }
}

TEST(ShippedFigures, TolerateWhatChanceExplainsAndNoMore) {
  const ErrorSummary shipped = summary(900, 2.0, 0.1, 0.998);
  // 3 * 0.1 * sqrt(1 + 900 / 50)
  EXPECT_NEAR(mean_tolerance_deg(shipped, 50), 0.3 * std::sqrt(19.0), 1e-12);
  EXPECT_EQ(worse_than(shipped, summary(50, 3.2, 0.5, 1.0)), "");
  EXPECT_NE(worse_than(shipped, summary(50, 3.4, 0.5, 1.0)), "");
  EXPECT_EQ(worse_than(shipped, summary(50, 2.0, 0.5, 0.98)), "");
  EXPECT_NE(worse_than(shipped, summary(50, 2.0, 0.5, 0.90)).find("90.0 % within 20°"), std::string::npos);
  EXPECT_EQ(worse_than(shipped, summary(50, 0.1, 0.0, 1.0)), "");
}

}  // namespace
}  // namespace tumblesight::sim
