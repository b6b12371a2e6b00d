#include "sim/report/results_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "sim/host/text.hpp"
#include "sim/report/error_tables.hpp"
#include "tests/support/sample_results.hpp"

namespace tumblesight::sim {
namespace {

TEST(DataTable, IsWrittenForTerminalMarkdownAndHtml) {
  const DataTable table{{"what", "error"},
                        {{{"a title"}}, {{"RCNN|x", Mark::kRcnn}, {"1.0°"}}, {{"CNN"}, {"-"}}}};
  EXPECT_EQ(terminal_text(table),
            "  what       error\n"
            " ──────────────────\n"
            "  a title\n"
            "    RCNN|x    1.0°\n"
            "    CNN          -\n");
  EXPECT_EQ(markdown_text(table),
            "| what | error |\n|---|---:|\n| a title |  |\n| **RCNN\\|x** | 1.0° |\n| CNN | - |\n\n");
  const std::string html = html_text(table, "results");
  EXPECT_NE(html.find("<tr class=group><th colspan=2>a title</th></tr>"), std::string::npos) << html;
  EXPECT_NE(html.find("<td><b class=rcnn>RCNN|x</b></td><td class=number>1.0°</td>"), std::string::npos)
      << html;
  EXPECT_NE(html.find("<span class=quiet>–</span>"), std::string::npos) << html;
}

TEST(DataTable, WithoutRowsIsEmpty) {
  const DataTable table{{"what", "error"}, {}};
  EXPECT_EQ(terminal_text(table) + markdown_text(table) + html_text(table, "results"), "");
}

TEST(DataTable, IsTransposed) {
  const DataTable table{{"what", "error", "share"},
                        {{{"RCNN", Mark::kRcnn}, {"1.0°"}, {"99 %"}}, {{"CNN"}, {"-"}, {"88 %"}}}};
  EXPECT_EQ(terminal_text(transposed(table)),
            "  what    RCNN    CNN\n"
            " ─────────────────────\n"
            "  error   1.0°      -\n"
            "  share   99 %   88 %\n");
}

TEST(CsvColumns, HaveDifferentNames) {
  std::set<std::string> names;
  for (const CsvColumn& column : csv_columns()) names.insert(column.name);
  EXPECT_EQ(names.size(), csv_columns().size());
}

// Every column of the tables with a line per condition is shown somewhere, and every line has as many cells
// as the header.
TEST(ConditionColumns, FillTheirTables) {
  ConditionTables shown = 0;
  for (const ConditionColumn& column : condition_columns()) {
    EXPECT_NE(column.tables, 0U) << column.heading;
    shown |= column.tables;
  }
  const Results results = sample_results();
  for (const ConditionTables kind :
       {kTerminalOverview, kPageOverview, kAccuracyTable, kOtherEstimatorsTable}) {
    const DataTable table = conditions_table(results.subjects, kind);
    EXPECT_NE(shown & kind, 0U);
    for (const auto& row : table.rows) {
      EXPECT_TRUE(row.size() == 1 || row.size() == table.header.size());
    }
  }
}

TEST(ByFrameTable, SelectsAtMostTenFramesAndEndsWithTheLast) {
  std::vector<FrameResult> results(37);
  for (std::uint32_t i = 0; i < results.size(); ++i) {
    results[i].frame = i;
    results[i].valid = true;
  }
  const std::string table = terminal_text(by_frame_table(errors_by_frame(results, 37)));
  const std::string header = table.substr(0, table.find('\n'));
  EXPECT_NE(header.find(" 37"), std::string::npos) << header;
  EXPECT_LE(header.size(), 100U);
}

TEST(CellTable, ShowsEveryEstimatorWithItsErrorAndThePapersFigures) {
  CellResult cell;
  cell.frames = 10;
  cell.rcnn = summarise({1.0, 3.0});
  cell.cnn = summarise({10.0, 30.0});
  cell.baseline = summarise({50.0});
  const std::string table = terminal_text(cell_table("near_shoemaker", cell));
  for (const char* part : {"RCNN, 10 frames", "2.00 ± 1.00°", "12.69°", "88 %", "20.00 ± 10.00°", "40.94°"}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  }
  EXPECT_EQ(table.find("50.00 ±"), std::string::npos) << "the error of a single sequence cannot be known";
}

TEST(CellTable, FitsATerminalOfAHundredColumns) {
  CellResult cell;
  cell.frames = 1000;
  cell.rcnn = summarise({100.0, 30.0});
  cell.cnn = cell.rcnn;
  cell.baseline = cell.rcnn;
  std::istringstream lines(terminal_text(transposed(cell_table("near_shoemaker", cell))));
  int read = 0;
  for (std::string line; std::getline(lines, line); ++read) EXPECT_LE(columns_of(line), 100U) << line;
  EXPECT_GE(read, 8);
}

TEST(PosesTable, HasALinePerConditionWithAPose) {
  Results results = sample_results();
  EXPECT_TRUE(poses_table(results.subjects[0]).rows.empty());
  results.subjects[0].cells[1].pose = sample_poses();
  results.subjects[0].cells[1].pose.inside_95 = std::nan("");
  const DataTable table = poses_table(results.subjects[0]);
  ASSERT_EQ(table.rows.size(), 1U);
  ASSERT_EQ(table.rows[0].size(), table.header.size());
  EXPECT_EQ(table.rows[0].front().text, "occluded");
  EXPECT_EQ(table.header[1], "first frame, mean within 20°");
  EXPECT_EQ(table.rows[0][1].text, "-") << "no first frame has a pose";
  EXPECT_EQ(table.header.back(), "inside 95 %");
  EXPECT_EQ(table.rows[0].back().text, "-");
}

// Verifies TS-SIL-200.
TEST(CellTable, OfADisturbedRunHasNoFiguresOfThePaper) {
  CellResult cell;
  cell.rcnn = summarise({1.0, 3.0});
  cell.disturbances.lost_frames = 1;
  EXPECT_EQ(terminal_text(cell_table("near_shoemaker", cell)).find("in the paper"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim
