#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "sim/report/results_table.hpp"
#include "sim/terminal/progress.hpp"
#include "sim/terminal/table.hpp"

namespace tumblesight::sim {
namespace {

TEST(Table, AlignsColumnsOfUtf8Text) {
  Table table({"what", "error", "share"});
  table.row({"RCNN", "4.1°", "99.8 %"});
  table.row({"a longer name", "12.69°"});
  EXPECT_EQ(table.text(),
            "  what             error    share\n"
            " ─────────────────────────────────\n"
            "  RCNN              4.1°   99.8 %\n"
            "  a longer name   12.69°\n");
}

TEST(Table, RefusesSurplusCells) {
  Table table({"one"});
  EXPECT_THROW(table.row({"1", "2"}), std::invalid_argument);
}

TEST(ByFrameTable, SelectsAtMostTenFramesAndEndsWithTheLast) {
  std::vector<FrameResult> results(37);
  for (std::uint32_t i = 0; i < results.size(); ++i) {
    results[i].frame = i;
    results[i].valid = true;
  }
  const std::string table = by_frame_table(errors_by_frame(results, 37));
  const std::string header = table.substr(0, table.find('\n'));
  EXPECT_NE(header.find(" 37"), std::string::npos) << header;
  EXPECT_LE(header.size(), 100U);
}

TEST(CellTable, ShowsEveryEstimatorWithItsErrorAndThePapersFigures) {
  const ErrorSummary rcnn = summarise({1.0, 3.0});
  const std::string table = cell_table(rcnn, summarise({10.0, 30.0}), summarise({50.0}), 10,
                                       paper_figures("near_shoemaker", Condition::kNominal));
  for (const char* part : {"2.00 ± 1.00°", "12.69°", "88 %", "20.00 ± 10.00°", "40.94°", "1 sequences"}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  }
  EXPECT_EQ(table.find("50.00 ±"), std::string::npos) << "the error of a single sequence cannot be known";
}

TEST(Progress, TellsRateAndTimeLeft) {
  EXPECT_EQ(progress_line("simulating", "frames", 50, 200, 10.0, 0),
            "  simulating   25 %  50/200 frames  5.0/s  30 s left");
  EXPECT_EQ(progress_line("simulating", "frames", 200, 200, 100.0, 0),
            "  simulating  100 %  200/200 frames  2.0/s  took 1 min 40 s");
  EXPECT_EQ(progress_line("x", "frames", 0, 200, 0.0, 4), "  x  ────    0 %  0/200 frames");
}

TEST(Progress, PrintsFewLinesIntoAFileTheLastOfThemWhenDone) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  {
    ProgressBar bar("job", "steps", 1000, file);
    for (std::uint64_t i = 0; i <= 1000; ++i) bar.update(i);
  }
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  std::fclose(file);
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_NE(text.find("100 %  1000/1000 steps"), std::string::npos) << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 10);
}

}  // namespace
}  // namespace tumblesight::sim
