#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "sim/evaluation/progress.hpp"
#include "sim/evaluation/table.hpp"

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
