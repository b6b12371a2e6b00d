#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/host/progress.hpp"
#include "sim/host/table.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "tests/support/temporary_folder.hpp"

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

TEST(Table, BreaksItsHeadingsInTwoWhenItIsTooWide) {
  const std::string wide(36, 'c');
  const std::vector<std::string> header{"error of the last frame", "mean within 20°", "right"};
  Table fits(header);
  fits.row({"RCNN", wide, "1"});
  EXPECT_EQ(fits.text().find("  error of the last frame   "), 0U) << fits.text();
  Table table(header);
  table.row({"RCNN", "1.00°", wide + wide});
  EXPECT_EQ(table.text().substr(0, table.text().find(" ─")),
            "  error of the         mean\n"
            "  last frame     within 20°" +
                std::string(70, ' ') + "right\n");
}

TEST(Table, RefusesSurplusCells) {
  Table table({"one"});
  EXPECT_THROW(table.row({"1", "2"}), std::invalid_argument);
}

TEST(ShellWord, IsQuotedOnlyIfItNeedsTo) {
  EXPECT_EQ(shell_word("--mesh=a/b.stl"), "--mesh=a/b.stl");
  EXPECT_EQ(shell_word("my mesh.stl"), "'my mesh.stl'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("$HOME"), "'$HOME'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(Text, ShellWordsAreThoseThatWereJoined) {
  const std::vector<std::string> words{"--mesh=a/b.stl", "my mesh.stl", "it's", "$HOME", "",
                                       "a\"b",           "c\\d",        "'"};
  std::string line;
  for (const std::string& word : words) line += "  " + shell_word(word);
  EXPECT_EQ(shell_words(line), words);
  EXPECT_EQ(shell_words("--hostfile \"my hosts\" a\\ b"),
            (std::vector<std::string>{"--hostfile", "my hosts", "a b"}));
  EXPECT_TRUE(shell_words("  ").empty());
}

TEST(Text, IsShortenedBetweenCharactersAndWithoutControls) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc...");
  EXPECT_EQ(shortened("ab°d", 3), "ab...") << "the sign has two bytes";
  EXPECT_EQ(shortened("ab°d", 4), "ab°...");
  EXPECT_EQ(shortened("\033[2J\n"), "?[2J?");
  EXPECT_EQ(shortened("\xff\xb0 \xc2 \xe2\x82"), "?? ? ??") << "not UTF-8";
  for (const char* good :
       {"", "a°", "\xed\x9f\xbf", "\xee\x80\x80", "\xe0\xa0\x80", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(is_utf8(good)) << good;
  // Halves of pairs, longer forms of shorter characters, beyond the last one, cut off.
  for (const char* bad : {"\xed\xa0\x80", "\xed\xbf\xbf", "\xe0\x9f\xbf", "\xf0\x8f\xbf\xbf",
                          "\xf4\x90\x80\x80", "\xc0\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\xb0"})
    EXPECT_FALSE(is_utf8(bad)) << bad;
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

TEST(Wrapped, BreaksTextAtSpaces) {
  EXPECT_EQ(wrapped("", 8), "");
  EXPECT_EQ(wrapped("one two three", 7), "one two\nthree");
  EXPECT_EQ(wrapped("a muchlongerword b", 4), "a\nmuchlongerword\nb");
  EXPECT_EQ(wrapped("±1° ±2°", 7), "±1° ±2°");
}

TEST(WriteFile, MakesFoldersAndLeavesNoPartialFile) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tumblesight_report_test";
  std::filesystem::remove_all(folder);
  write_file((folder / "deep" / "file.html").string(), "content");
  std::ifstream file(folder / "deep" / "file.html");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "content");
  const auto files = std::distance(std::filesystem::directory_iterator(folder / "deep"), {});
  EXPECT_EQ(files, 1);
  std::filesystem::remove_all(folder);
}

TEST(WriteFile, LeavesTheOldFileIfTheNewOneCannotBeWritten) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tumblesight_limited_file";
  std::filesystem::remove_all(folder);
  const std::string path = (folder / "recording.tslr").string();
  write_file(path, "old");
  // Larger than a file of this process may be: the write fails in the middle, as on a full disk.
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const rlimit small{4096, limit.rlim_max};
  const auto previous = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_file(path, std::vector<std::uint8_t>(100000, 1)), std::runtime_error);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, previous);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::ifstream file(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "old");
  std::filesystem::remove_all(folder);
}

TEST(WriteFile, WritesThroughALinkAndKeepsIt) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tumblesight_linked_file";
  std::filesystem::remove_all(folder);
  write_file((folder / "file").string(), "old");
  std::filesystem::create_symlink("file", folder / "link");
  write_file((folder / "link").string(), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  std::ifstream file(folder / "file");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "new");
  std::filesystem::remove_all(folder);
}

// Under the name of the partial file, which can be known beforehand: a link to a file of this user, a pipe,
// and a file that is left over.
TEST(WriteFile, IsNotLedAstrayByWhatHasTheNameOfItsPartialFile) {
  const TemporaryFolder folder;
  const std::string path = folder.path("report.html"), own = folder.path("own");
  write_file(own, "precious");
  const std::string partial = partial_path(path);
  std::filesystem::create_symlink(own, partial);
  ASSERT_EQ(mkfifo((partial + "1").c_str(), 0666), 0);
  std::ofstream(partial + "2") << "left over";
  EXPECT_EQ(fault_of_new_file(path), "");
  write_file(path, "new");
  std::ifstream file(path), precious(own);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "new");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(precious), {}), "precious");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path("")), {}), 5);
  for (int i = 3; i < 16; ++i) std::ofstream(partial + std::to_string(i)) << "left over";
  EXPECT_NE(fault_of_new_file(path).find("delete " + partial + "*"), std::string::npos);
  EXPECT_THROW(write_file(path, "newer"), std::runtime_error);
}

constexpr uid_t kOtherUser = 65534;

// As /tmp, where every user may make files and only the owner may delete one.
TEST(WriteFile, RefusesWhatAnotherUserHasPutIntoASharedFolder) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make files of another user";
  const TemporaryFolder folder;
  const std::string path = folder.path("report.html"), own = folder.path("own");
  write_file(own, "precious");
  ASSERT_EQ(chmod(folder.path("").c_str(), 01777), 0);
  for (const bool is_link : {true, false}) {
    std::filesystem::remove(path);
    if (is_link)
      std::filesystem::create_symlink(own, path);
    else
      ASSERT_EQ(mkfifo(path.c_str(), 0666), 0);
    ASSERT_EQ(lchown(path.c_str(), kOtherUser, kOtherUser), 0);
    EXPECT_NE(fault_of_place(path), "");
    EXPECT_THROW(write_file(path, "led astray"), std::runtime_error);
  }
  std::ifstream precious(own);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(precious), {}), "precious");
  std::filesystem::remove(path);
  std::ofstream(path) << "of somebody else";
  ASSERT_EQ(chown(path.c_str(), kOtherUser, kOtherUser), 0);
  EXPECT_EQ(fault_of_place(path), "") << "root may replace it";
  ASSERT_EQ(seteuid(kOtherUser - 1), 0);
  EXPECT_NE(fault_of_place(path), "") << "found out before the run, not by rename() after it";
  ASSERT_EQ(seteuid(0), 0);
}

// A container's root, in a folder of the user outside it.
TEST(WriteFile, TakesALinkOfTheOneWhoOwnsTheFolder) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make files of another user";
  const TemporaryFolder folder;
  const std::string link = folder.path("latest.html"), file = folder.path("report.html");
  write_file(file, "old");
  std::filesystem::create_symlink("report.html", link);
  for (const std::string& path : {folder.path(""), link, file})
    ASSERT_EQ(lchown(path.c_str(), kOtherUser, kOtherUser), 0);
  write_file(link, "new");
  std::ifstream written(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), "new");
  EXPECT_EQ(fault_of_place("/dev/stdout"), "");
  EXPECT_EQ(fault_of_place("/dev/null"), "");
}

TEST(WriteFile, SaysWhichFileCannotBeWritten) {
  try {
    write_file("/proc/no/such/file", "content");
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/no/such"), std::string::npos);
  }
}

}  // namespace
}  // namespace tumblesight::sim
