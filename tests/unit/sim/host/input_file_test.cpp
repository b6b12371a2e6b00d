// Input files: what is refused unread, in bounded time and memory, and what counts as a file.
#include "sim/host/input_file.hpp"

#include <gtest/gtest.h>

#include "tests/support/hostile_files.hpp"

namespace tumblesight::sim {
namespace {

constexpr InputKind kNote{"note", 1000};

TEST(InputFile, RefusesWhatIsNoRegularFileOrTooLargeForItsKind) {
  const HostileFiles hostile(".txt");
  const std::pair<const char*, const char*> expected[] = {
      {"folder", "cannot be read: it is a folder; give a file"},
      {"pipe", "cannot be read: it is a pipe; write its content to a file first"},
      {"device", "cannot be read: it is a device; give a file"},
      {"socket", "cannot be read: it is a socket"},
      {"huge", "cannot be read: it has 3221225472 bytes, and a note has at most 1000: is it another file?"},
      {"unreadable", "cannot be read: Permission denied"}};
  for (const HostileFile& file : hostile.files()) {
    const Outcome outcome = outcome_of([&] { (void)read_text(file.path, kNote); });
    EXPECT_EQ(outcome.signal, 0) << file.kind;
    for (const auto& [kind, text] : expected) {
      if (file.kind != kind) continue;
      EXPECT_NE(outcome.message.find("note '" + file.path + "' " + text), std::string::npos)
          << outcome.message;
    }
    EXPECT_EQ(outcome.message.empty(), file.kind == "empty");
    EXPECT_FALSE(begins_with(file.path, "x"));
    EXPECT_EQ(fault_of_input(file.path, kNote), outcome.message);
  }
}

TEST(InputFile, GivesTheBytesOfARegularFileAndOfALinkToOne) {
  const TemporaryFolder folder;
  const std::string path = folder.put("a", {'o', 'n', 'e', '\0', '2'}), link = folder.path("link");
  std::filesystem::create_symlink(path, link);
  for (const std::string& name : {path, link}) {
    const InputFile file(name, kNote);
    EXPECT_EQ(file.size(), 5U);
    EXPECT_EQ(file.text(), std::string("one\0"
                                       "2",
                                       5));
    EXPECT_EQ(file.bytes(), (std::vector<std::uint8_t>{'o', 'n', 'e', 0, '2'}));
    char two[4] = {};
    EXPECT_EQ(file.read_at(3, two, sizeof two), 2U);
    std::string word;
    EXPECT_TRUE(std::getline(file.stream(), word, '\0'));
    EXPECT_EQ(word, "one");
    EXPECT_TRUE(begins_with(name, "one"));
    EXPECT_FALSE(begins_with(name, "two"));
    EXPECT_FALSE(begins_with(name, std::string(6, 'o')));
  }
}

TEST(InputFile, StaysTheFileThatWasChecked) {
  const TemporaryFolder folder;
  const std::string path = folder.put("a", {'1'});
  const InputFile file(path, kNote);
  std::filesystem::remove(path);
  (void)mkfifo(path.c_str(), 0600);
  EXPECT_EQ(file.text(), "1");
  std::string word;
  EXPECT_TRUE(std::getline(file.stream(), word));
  EXPECT_EQ(word, "1");
}

TEST(InputFile, TellsAMissingFile) {
  try {
    (void)read_text("/no/such/file", kNote);
    FAIL() << "accepted";
  } catch (const InputRefused& refusal) {
    EXPECT_TRUE(refusal.is_missing());
    EXPECT_STREQ(refusal.what(),
                 "note '/no/such/file' cannot be read; give an existing file (No such file or directory)");
  }
}

}  // namespace
}  // namespace tumblesight::sim
