#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "sim/terminal/progress.hpp"
#include "sim/terminal/table.hpp"
#include "sim/terminal/text_file.hpp"

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

TEST(Progress, ShowsRateAndTimeLeft) {
  EXPECT_EQ(progress_line("simulating", "frames", 50, 200, 10.0, 0),
            "  simulating   25 %  50/200 frames  5.0/s  30 s left");
  EXPECT_EQ(progress_line("simulating", "frames", 200, 200, 100.0, 0),
            "  simulating  100 %  200/200 frames  2.0/s  took 1 min 40 s");
  EXPECT_EQ(progress_line("x", "frames", 0, 200, 0.0, 4), "  x  ────    0 %  0/200 frames");
}

TEST(Progress, CountsOnlyTheWorkOfThisRunForTheRate) {
  EXPECT_EQ(progress_line("cnn", "images", 150, 200, 10.0, 0, 100),
            "  cnn   75 %  150/200 images  5.0/s  10 s left");
  EXPECT_EQ(progress_line("cnn", "images", 100, 200, 10.0, 0, 100), "  cnn   50 %  100/200 images");
}

TEST(Progress, PrintsFewLinesIntoAFileTheLastOfThemWhenDone) {
  std::FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  {
    ProgressBar bar("job", "steps", 1000, file);
    for (std::uint64_t i = 0; i <= 1000; ++i) bar.update(i, "loss 0.5");
  }
  std::rewind(file);
  std::string text;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) text += static_cast<char>(c);
  std::fclose(file);
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_NE(text.find("100 %  1000/1000 steps"), std::string::npos) << text;
  EXPECT_NE(text.find("loss 0.5\n"), std::string::npos) << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 10);
}

TEST(WriteTextFile, MakesFoldersAndLeavesNoPartialFile) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tumblesight_report_test";
  std::filesystem::remove_all(folder);
  write_text_file((folder / "deep" / "file.html").string(), "content");
  std::ifstream file(folder / "deep" / "file.html");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "content");
  const auto files = std::distance(std::filesystem::directory_iterator(folder / "deep"), {});
  EXPECT_EQ(files, 1);
  std::filesystem::remove_all(folder);
}

TEST(WriteTextFile, SaysWhichFileCannotBeWritten) {
  try {
    write_text_file("/proc/no/such/file", "content");
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/no/such"), std::string::npos);
  }
}

}  // namespace
}  // namespace tumblesight::sim
