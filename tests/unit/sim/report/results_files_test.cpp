// Results as JSON, CSV, Markdown and HTML page.
#include "sim/report/results_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "sim/report/error_json.hpp"
#include "sim/report/results_json.hpp"
#include "tests/support/sample_results.hpp"
#include "tests/unit/sim/report/markup_checks.hpp"

namespace tumblesight::sim {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Fields of a CSV line, quotes resolved.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

TEST(SummaryJson, HoldsTheFiguresThenTheStandardErrors) {
  const nlohmann::ordered_json json = summary_json(summarise({10.0, 30.0, 2.0, 2.0}));
  EXPECT_EQ(
      json.dump().substr(0, 94),
      R"({"mean_deg":11.0,"median_deg":6.0,"within_20deg":0.75,"within_5deg":0.5,"mean_within_20_deg":4)");
  EXPECT_NEAR(json["mean_within_20_deg"].get<double>(), 14.0 / 3.0, 1e-12);
  EXPECT_TRUE(nlohmann::json::parse(json.dump())["wrong_and_valid"].is_null()) << "validity is not known";
}

TEST(SummaryJson, HasTheSharesThatTheFlightProgramCallsValid) {
  std::vector<FrameResult> results{result_with(0, 0, 3.0, 3.0), result_with(1, 0, 30.0, 3.0)};
  for (FrameResult& result : results) result.trusted = true;
  const nlohmann::ordered_json json = summary_json(last_frame_summary(results, 1, Estimator::kRcnn));
  EXPECT_EQ(json["wrong_and_valid"], 0.5);
  EXPECT_EQ(json["right_and_valid"], 0.5);
}

TEST(SummaryJson, IsNullWithoutASequence) {
  const nlohmann::ordered_json json = summary_json({});
  EXPECT_EQ(json.size(), 9U);
  for (const auto& [key, value] : json.items()) EXPECT_TRUE(value.is_null()) << key;
}

// Verifies TS-SIL-390.
TEST(ResultsFiles, NameTheSymmetryAndLeaveOutThePapersFigures) {
  Results results = sample_results();
  EXPECT_EQ(results_csv(results).find("symmetry"), std::string::npos);
  EXPECT_EQ(results_json(results)["rows"][0].count("symmetry"), 0U);
  results.subjects.pop_back();
  for (CellResult& cell : results.subjects[0].cells) cell.symmetry = target_symmetry_from({"z:4"});
  const nlohmann::ordered_json row = results_json(results)["rows"][0];
  EXPECT_EQ(row["symmetry"], "1/4 turn about z");
  EXPECT_TRUE(row["paper_rcnn"].is_null());
  EXPECT_NE(results_csv(results).find(",symmetry\n"), std::string::npos);
  EXPECT_NE(results_markdown(results).find("nominal, modulo 1/4 turn about z"), std::string::npos);
  const std::string page = results_page(results);
  EXPECT_NE(page.find("Errors modulo the symmetry of the target: 1/4 turn about z."), std::string::npos);
  EXPECT_EQ(page.find("12.69"), std::string::npos) << "the paper's figure";
}

// Verifies TS-SIL-380.
TEST(ResultsPage, LeadsWithTheConditionsWhoseAttitudesAreMostlyWrong) {
  Results results = sample_results();
  results.subjects.pop_back();
  EXPECT_EQ(results_page(results).find("does not know the attitude"), std::string::npos);
  EXPECT_EQ(results_json(results)["rows"][1].count("mostly_wrong"), 0U);
  results.subjects[0].cells[1] = sample_cell(Condition::kOccluded, 120.0, false);
  const std::string page = results_page(results);
  EXPECT_NE(
      page.find("<p class=lead>The network does not know the attitude of NEAR Shoemaker in these frames. "
                "Condition occluded: 100 % of the attitudes are more than 20° off, and their mean error of "
                "124.0° is what guessing gives"),
      std::string::npos);
  EXPECT_EQ(results_json(results)["rows"][1]["mostly_wrong"], true);
}

TEST(ResultsJson, HasARowForEachSubjectAndCondition) {
  const nlohmann::ordered_json json = results_json(sample_results());
  ASSERT_EQ(json.at("rows").size(), 3U);
  const auto& row = json["rows"][1];
  std::string keys;
  for (const auto& [key, value] : row.items()) keys += key + " ";
  EXPECT_EQ(keys.substr(0, 66), "target mesh condition sequences rcnn cnn pose pose_first baseline ");
  EXPECT_EQ(row["condition"], "occluded");
  EXPECT_EQ(row["sequences"], 40);
  EXPECT_EQ(row["seed"], 7);
  EXPECT_EQ(row["model_crc32"], "00c0ffee");
  EXPECT_EQ(row["baseline"]["sequences"], 3);
  EXPECT_DOUBLE_EQ(row["baseline"]["mean_deg"].get<double>(), 31.0);
  EXPECT_DOUBLE_EQ(row["paper_rcnn"]["mean_deg"].get<double>(), 22.86);
  EXPECT_TRUE(json["rows"][2]["baseline"].is_null());
  EXPECT_TRUE(json["rows"][2]["paper_rcnn"].is_null());
}

TEST(ResultsJson, HasTheCurvesOfSubjectsThatWereSwept) {
  const nlohmann::ordered_json json = results_json(sample_results());
  ASSERT_EQ(json.at("curves").size(), 1U);
  EXPECT_EQ(json["curves"][0]["by_hidden_share"].size(), 2U);
  EXPECT_EQ(json["curves"][0]["by_range_m"].size(), 8U);
  EXPECT_EQ(json["curves"][0]["long_run_by_frame"].size(), 30U);
}

TEST(ResultsCsv, HasALinePerEstimatorWithAsManyFieldsAsTheHeader) {
  const std::vector<std::string> lines = lines_of(results_csv(sample_results()));
  ASSERT_EQ(lines.size(), 1U + 3U + 3U + 2U);
  const std::size_t columns = fields_of(lines.front()).size();
  for (const std::string& line : lines) EXPECT_EQ(fields_of(line).size(), columns) << line;
  EXPECT_NE(lines[1].find("\"near, \"\"odd\"\".stl\""), std::string::npos) << lines[1];
  const std::vector<std::string> fields = fields_of(lines[3]);
  EXPECT_EQ(fields[7], "baseline");
  EXPECT_EQ(fields[8], "3");
  EXPECT_EQ(fields[9], "31.0000");
}

TEST(ResultsJson, HasThePosesWhereThereAreAny) {
  Results results = sample_results();
  results.subjects[0].cells[1].pose = sample_poses();
  results.subjects[0].cells[1].pose_first = sample_poses();
  results.subjects[0].cells[1].pose_first.inside_95 = std::nan("");
  const nlohmann::ordered_json rows = results_json(results)["rows"];
  EXPECT_TRUE(rows[0]["pose"].is_null());
  EXPECT_TRUE(rows[0]["pose_first"].is_null());
  EXPECT_EQ(rows[1]["pose"].dump(),
            R"({"mean_deg":1.5,"mean_within_20_deg":0.25,"median_deg":0.125,"within_20deg":0.975,)"
            R"("across_m":0.0031,"along_m":0.0042,"rate_deg_s":0.0153,"velocity_m_s":0.0064,)"
            R"("verified":0.9,"verified_wrong":0.05,"inside_95":0.925})");
  EXPECT_TRUE(rows[1]["pose_first"]["inside_95"].is_null()) << "no pose is verified";
}

TEST(ResultsCsv, HasThePosesInTheLinesOfTheRcnn) {
  Results results = sample_results();
  EXPECT_EQ(results_csv(results).find("pose_"), std::string::npos);
  results.subjects[0].cells[1].pose = sample_poses();
  results.subjects[0].cells[1].pose_first = sample_poses();
  results.subjects[0].cells[1].pose_first.inside_95 = std::nan("");
  const std::vector<std::string> lines = lines_of(results_csv(results));
  const std::vector<std::string> header = fields_of(lines[0]);
  const auto field = [&](std::size_t line, const std::string& name) {
    const auto place = std::find(header.begin(), header.end(), name) - header.begin();
    return fields_of(lines.at(line)).at(static_cast<std::size_t>(place));
  };
  EXPECT_EQ(field(4, "estimator") + field(4, "condition"), "rcnnoccluded");
  EXPECT_EQ(field(4, "pose_mean_deg"), "1.5000");
  EXPECT_EQ(field(4, "pose_velocity_m_s"), "0.00640");
  EXPECT_EQ(field(4, "pose_first_within_20deg"), "0.97500");
  EXPECT_EQ(field(4, "pose_first_inside_95"), "");
  EXPECT_EQ(field(1, "pose_mean_deg"), "") << "no pose under this condition";
  EXPECT_EQ(field(5, "pose_mean_deg"), "") << "the CNN";
}

// Verifies TS-SIL-200.
TEST(Disturbances, OfARunAreInItsJsonAndCsv) {
  Results results = sample_results();
  results.subjects[0].cells[0].disturbances.lost_frames = 2;
  results.subjects[0].cells[0].disturbances.period_s = 1.5;
  results.subjects[0].cells[0].disturbances.no_ego_motion = true;
  const nlohmann::ordered_json rows = results_json(results)["rows"];
  EXPECT_EQ(rows[0]["disturbances"].dump(), R"({"lost-frames":2,"period":1.5,"no-ego-motion":true})");
  EXPECT_EQ(rows[1]["disturbances"].dump(), "{}");
  const std::vector<std::string> lines = lines_of(results_csv(results));
  EXPECT_EQ(fields_of(lines[0]).back(), "disturbances");
  EXPECT_EQ(fields_of(lines[1]).back(), "lost-frames 2, period 1.5, no-ego-motion");
  EXPECT_EQ(fields_of(lines[4]).back(), "");
}

// Verifies TS-SIL-320.
TEST(Sensor, OtherThanThePapersIsInJsonAndCsvAndHasNoFiguresOfThePaper) {
  Results results = sample_results();
  CellResult& cell = results.subjects[0].cells[0];
  cell.sensor = sensor_named("flash_256");
  cell.ranges = {50.0, 200.0};
  const nlohmann::ordered_json row = results_json(results)["rows"][0];
  EXPECT_EQ(row["sensor"]["name"], "flash_256");
  EXPECT_EQ(row["ranges_m"], nlohmann::ordered_json::parse("[50.0, 200.0]"));
  EXPECT_TRUE(row["paper_rcnn"].is_null());
  EXPECT_EQ(differences_from_paper(cell), "sensor flash_256, 50 to 200 m");
  cell.ranges = {57.7, 57.75};
  EXPECT_EQ(differences_from_paper(cell), "sensor flash_256, 57.7 to 57.75 m");
  const std::vector<std::string> lines = lines_of(results_csv(results));
  EXPECT_NE(lines[0].find(",sensor,ranges_m"), std::string::npos);
  EXPECT_NE(lines[1].find("flash_256 (CRC-32 "), std::string::npos);
}

// Verifies TS-SIL-300, TS-SIL-310.
TEST(Effects, OfARunAreInItsJsonAndCsv) {
  Results results = sample_results();
  const nlohmann::ordered_json plain = results_json(results)["rows"];
  const std::string plain_csv = results_csv(results);
  results.subjects[0].cells[0].effects = effects_from({"noise=5", "plume=0.01"});
  results.subjects[0].cells[0].rcnn.error_below_3_expected = 0.75;
  results.subjects[0].cells[0].rcnn.expected_over_real = 0.5;
  const nlohmann::ordered_json rows = results_json(results)["rows"];
  EXPECT_EQ(rows[0]["effect"], "plume=0.01,noise=5");
  EXPECT_EQ(rows[0]["rcnn"]["error_below_3_expected"], 0.75);
  EXPECT_EQ(rows[0]["rcnn"]["expected_over_real"], 0.5);
  EXPECT_EQ(rows[0]["by_range_m"].size(), 8U);
  EXPECT_TRUE(rows[0]["goal"].is_null()) << "the paper has no effects";
  EXPECT_TRUE(rows[1]["effect"].is_null());
  EXPECT_EQ(rows[1].dump(), plain[1].dump());
  EXPECT_EQ(plain[1].count("by_range_m"), 0U);
  const std::vector<std::string> lines = lines_of(results_csv(results));
  EXPECT_EQ(fields_of(lines[0]).back(), "effect");
  EXPECT_EQ(fields_of(lines[1]).back(), "plume=0.01,noise=5");
  EXPECT_EQ(lines[4], lines_of(plain_csv)[4] + ",");
}

TEST(ResultsMarkdown, ShowsOursAndThePapersWithCrcAndSeed) {
  const std::string text = results_markdown(sample_results());
  for (const char* part : {"`00c0ffee`", "`12345678`", "seed 7", "12.69°, 88 %", "40.94°, 45 %",
                           "tumblesight evaluate --paper", "magellan is left out", "| occluded | 40 |"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

// The lines of a results document that do not depend on the run: text and table headings, with every number
// as #. The table of frames has a column per condition.
std::set<std::string> wording(const std::string& document) {
  std::set<std::string> lines;
  std::string before;
  for (const std::string& line : lines_of(document)) {
    const bool table = line.rfind("|", 0) == 0;
    if (line.rfind("|---", 0) == 0 && before.rfind("| frame | ", 0) != 0) lines.insert(before);
    before.clear();
    for (const char c : line) {
      const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
      if (!digit || before.empty() || before.back() != '#') before += digit ? '#' : c;
    }
    const bool of_the_run = line.rfind("### ", 0) == 0 || line.rfind("- Note: ", 0) == 0 ||
                            line.rfind("`", 0) == 0 || line.rfind("tumblesight ", 0) == 0;
    if (!table && !of_the_run) lines.insert(before);
  }
  return lines;
}

// docs/results.md takes hours to make, so its wording is edited together with the generator's.
TEST(ResultsMarkdown, WordsAreThoseOfTheStoredDocument) {
  std::ostringstream stored;
  stored << std::ifstream(TUMBLESIGHT_SOURCE_DIR "/docs/results.md").rdbuf();
  const std::set<std::string> expected = wording(stored.str());
  const std::set<std::string> generated = wording(results_markdown(sample_results()));
  EXPECT_GT(generated.size(), 30U);
  for (const std::string& line : generated) EXPECT_EQ(expected.count(line), 1U) << line;
}

TEST(ResultsMarkdown, ShowsDisturbedRunsWithTheirBars) {
  Results results = sample_results();
  EXPECT_EQ(results_markdown(results).find("Disturbed sequences"), std::string::npos);
  CellResult cell = results.subjects[0].cells[0];
  cell.disturbances.lost_frames = 1;
  cell.rcnn.mean_within_20_deg = 1.4;
  results.subjects[0].disturbed = {cell};
  cell.pose = sample_poses();
  cell.disturbances.lost_frames = 9;
  results.subjects[0].disturbed.push_back(cell);
  const std::string text = results_markdown(results);
  EXPECT_NE(text.find("| nominal | lost-frames 1 | 1.40"), std::string::npos) << text;
  EXPECT_NE(text.find("| 1.15 times the mean, 0.2 % fewer within 20° | "), std::string::npos) << text;
  EXPECT_NE(text.find("yes | - | - | - |"), std::string::npos) << "no poses";
  EXPECT_NE(text.find("| nominal | lost-frames 9 | 1.40"), std::string::npos) << "no bar";
  EXPECT_NE(text.find(" - |  | 0.250° | 97.5"), std::string::npos) << text;
  EXPECT_EQ(results_json(results)["rows"].size(), 5U);
  EXPECT_EQ(lines_of(results_csv(results)).size(), 1U + 3U + 3U + 2U + 4U);
}

TEST(ResultsDocuments, ShowGoalsAndTrustOfTheRunsThatHaveThem) {
  Results results = sample_results();
  EXPECT_EQ(results_markdown(results).find("## Goals"), std::string::npos) << "no poses";
  CellResult cell = results.subjects[0].cells[0];
  cell.pose = sample_poses();
  cell.rcnn.within_20deg = 0.8;
  cell.rcnn.right_and_valid = 0.4;
  cell.rcnn.wrong_and_valid = 0.1;
  cell.rcnn.error_below_3_expected = 0.99;
  cell.rcnn.expected_over_real = 1.0;
  cell.effects.plume = 0.01;
  results.subjects[0].sensor_runs = {cell};
  cell.effects = {};
  cell.effects.sphere = 1.0;
  cell.never_valid_from_fifth = 1.0;
  results.subjects[0].sensor_runs.push_back(cell);
  const std::string text = results_markdown(results);
  EXPECT_NE(text.find("| plume=0.01 | 40 | 80.0 % | 0.250° | 97.5"), std::string::npos) << text;
  EXPECT_NE(
      text.find("| **0.20°, 99.8 %** | 10.0 % | 50.0 % | 99.0 % | 1.00 | 90.0 % | 5.0 % | 0.0 % | **no** | "
                "**no: wrong and valid, right and valid** |"),
      std::string::npos)
      << text;
  EXPECT_NE(
      text.find("| sphere=1 | 40 | - | - | - | - | 10.0 % | - | - | - | 90.0 % | 5.0 % | 100.0 % |  | yes |"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("4 of 40 last frames, 10.00 %; goal: at most 0.2 %, missed."), std::string::npos)
      << text;
  EXPECT_NE(results_page(results).find("<h2>Goals</h2>"), std::string::npos);
  cell.effects = {};
  cell.effects.lobe = 40.0;
  cell.pose.mean_within_20_deg = std::nan("");
  cell.pose.within_20deg = cell.rcnn.within_20deg = 0.0;
  results.subjects[0].sensor_runs = {cell};
  EXPECT_NE(results_markdown(results).find("| lobe=40 | 40 | 0.0 % | - | 0.0"), std::string::npos);
  EXPECT_EQ(results_markdown(results).find("nan"), std::string::npos);
  results.subjects[0].sensor_runs.push_back(cell);
  EXPECT_EQ(results_json(results)["rows"].size(), 5U);
}

TEST(ResultsDocuments, ShowThePosesWhereThereAreAny) {
  Results results = sample_results();
  EXPECT_EQ(results_markdown(results).find("Registered pose"), std::string::npos);
  EXPECT_EQ(results_page(results).find("Registered pose"), std::string::npos);
  results.subjects[1].cells[0].pose = sample_poses();
  results.subjects[1].cells[0].pose_first = sample_poses();
  const std::string markdown = results_markdown(results);
  EXPECT_NE(
      markdown.find("| offset | 0.250° | 97.5 % | 0.250° | 0.125° | 97.5 % | 3.1 mm | 4.2 mm | 0.015°/s | "
                    "6.4 mm/s | 90.0 % | 5.0 % | 92.5 % |"),
      std::string::npos)
      << markdown;
  const std::string page = results_page(results);
  EXPECT_NE(page.find("<h2>Registered pose</h2>\n<h3>mine, parametric mesh"), std::string::npos);
  EXPECT_NE(page.find("6.4 mm/s"), std::string::npos);
}

TEST(ResultsMarkdown, HoldsTablesWithAsManyCellsAsTheirHeader) {
  std::ptrdiff_t columns = 0;
  for (const std::string& line : lines_of(results_markdown(sample_results()))) {
    const std::ptrdiff_t bars = std::count(line.begin(), line.end(), '|');
    if (bars > 0 && columns > 0) {
      EXPECT_EQ(bars, columns) << line;
    }
    columns = bars;
  }
}

TEST(ResultsPage, HoldsWellFormedFigures) {
  const std::vector<std::string> svgs = svgs_of(results_page(sample_results()));
  EXPECT_EQ(svgs.size(), 10U);
  for (const std::string& svg : svgs) {
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

TEST(ResultsPage, NeedsNothingButItself) {
  EXPECT_EQ(outside_reference(results_page(sample_results())), "");
}

TEST(ResultsPage, ShowsEveryCellAndEscapesNames) {
  const std::string html = results_page(sample_results());
  for (const char* part : {"occluded", "offset", "12.69°, 88 %", "near, &quot;odd&quot;.stl",
                           "mine, parametric mesh", "00c0ffee", "magellan is left out"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
}

TEST(ResultsPage, OfOneCellHasItsFiguresWithoutSweeps) {
  Results results = sample_results();
  results.subjects.erase(results.subjects.begin());
  const std::vector<std::string> svgs = svgs_of(results_page(results));
  EXPECT_GE(svgs.size(), 5U);
  for (const std::string& svg : svgs) EXPECT_EQ(xml_fault(svg), "");
}

TEST(ResultsPage, OfNothingIsStillAPage) {
  EXPECT_NE(results_page({}).find("</html>"), std::string::npos);
}

}  // namespace

}  // namespace tumblesight::sim
