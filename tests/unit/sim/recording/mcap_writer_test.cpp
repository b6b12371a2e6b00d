#include "sim/recording/mcap_writer.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "tests/support/mcap_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Mcap : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string path_ = folder_.path("run.mcap");
};

// A console may still show it.
TEST_F(Mcap, WhoHasTheFileOpenKeepsItWhenItIsWrittenAgain) {
  McapWriter(path_, "first").close();
  const std::string before = bytes_of(path_);
  std::ifstream open(path_, std::ios::binary);
  McapWriter(path_, "the second one").close();
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(open), {}), before);
  EXPECT_NE(bytes_of(path_), before);
}

TEST_F(Mcap, APipeIsRefused) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_THROW(McapWriter(path_, "test"), std::runtime_error);
}

TEST_F(Mcap, ALinkToTheFileStays) {
  const std::string link = folder_.path("link.mcap");
  McapWriter(path_, "first").close();
  std::filesystem::create_symlink(path_, link);
  McapWriter(link, "the second one").close();
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_NE(bytes_of(path_).find("the second one"), std::string::npos);
}

TEST_F(Mcap, ALinkOfAnotherUserIsNotFollowedWhoeverOwnsItsFolder) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make files of another user";
  constexpr uid_t kOther = 65534;
  const std::string precious = folder_.put("precious", {'x'}), place = folder_.path("shared");
  std::filesystem::create_directory(place);
  std::filesystem::create_symlink(precious, place + "/link.mcap");
  std::filesystem::create_symlink(folder_.path(""), place + "/results");
  for (const std::string& path : {place, place + "/link.mcap", place + "/results"})
    ASSERT_EQ(lchown(path.c_str(), kOther, kOther), 0);
  ASSERT_EQ(chmod(place.c_str(), 0777), 0);
  EXPECT_THROW(McapWriter(place + "/link.mcap", "test"), std::runtime_error);
  EXPECT_THROW(McapWriter(place + "/results/precious", "test"), std::runtime_error);
  EXPECT_EQ(bytes_of(precious), "x");
}

// Verifies TS-SIL-190.
TEST_F(Mcap, HasWhatWasWrittenWithChecksumsAndIndices) {
  McapWriter writer(path_, "test");
  const McapId schema = writer.add_schema("Number", "jsonschema", R"({"type":"object"})");
  const McapId first = writer.add_channel("/first", "json", schema);
  const McapId second = writer.add_channel("/second", "json", schema);
  const std::string large(400'000, 'x');  // three make a chunk
  for (int i = 0; i < 10; ++i) writer.write(first, 1000 - i, large + std::to_string(i));
  writer.write(second, 7, R"({"a":1})");
  writer.close();
  const std::string bytes = bytes_of(path_);
  const McapReader reader(bytes);
  ASSERT_EQ(reader.messages.size(), 11U);
  EXPECT_EQ(reader.messages_in_statistics, 11U);
  EXPECT_EQ(reader.chunks(), 4U);
  EXPECT_EQ(reader.schemas.at(schema), "Number");
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(reader.messages[i].topic, "/first");
    EXPECT_EQ(reader.messages[i].sequence, i);
    EXPECT_EQ(reader.messages[i].time_ns, 1000 - i);
    EXPECT_EQ(reader.messages[i].data, large + std::to_string(i));
  }
  EXPECT_EQ(reader.messages[10].topic, "/second");
  EXPECT_EQ(reader.messages[10].sequence, 0U);
  EXPECT_EQ(reader.messages[10].data, R"({"a":1})");
}

TEST_F(Mcap, WithoutAMessageIsAValidFile) {
  McapWriter(path_, "test").close();
  const std::string bytes = bytes_of(path_);
  EXPECT_TRUE(McapReader(bytes).messages.empty());
}

// Of a program that is killed: chunks are on the disk as soon as they are full.
TEST_F(Mcap, WithoutItsEndHasEveryChunkThatWasWritten) {
  McapWriter writer(path_, "test");
  const McapId channel = writer.add_channel("/a", "json", writer.add_schema("A", "jsonschema", "{}"));
  const std::string large(600'000, 'x');
  for (int i = 0; i < 5; ++i) writer.write(channel, i, large);
  const std::string bytes = bytes_of(path_);
  EXPECT_EQ(McapReader(bytes, false).messages.size(), 4U);
}

TEST_F(Mcap, ThatCannotBeWrittenIsNamed) {
  try {
    McapWriter writer(folder_.path("none/run.mcap"), "test");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/none/run.mcap': cannot be written: No such file"),
              std::string::npos)
        << error.what();
  }
}

// Every write to this device fails as on a full disk.
TEST_F(Mcap, AFullDiskIsAnError) {
  EXPECT_THROW(McapWriter("/dev/full", "test"), std::runtime_error);
}

// Files may not grow beyond a limit, as on a disk without more space.
class LimitedFiles {
 public:
  explicit LimitedFiles(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
    signal_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~LimitedFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }

 private:
  rlimit before_{};
  void (*signal_)(int) = SIG_DFL;
};

// Records have an opcode, the length of their content in eight bytes, and the content.
bool ends_with_a_record(const std::string& file) {
  std::size_t at = 8;
  while (at + 9 <= file.size()) {
    std::size_t length = 0;
    for (std::size_t i = 8; i > 0; --i) length = length << 8 | static_cast<std::uint8_t>(file[at + i]);
    at += 9 + length;
  }
  return at == file.size();
}

// The file ends with a whole record, however much of the next one there was space for.
TEST_F(Mcap, HasWhatWasWrittenBeforeTheDiskWasFull) {
  for (const rlim_t bytes : {1'300'000U, 2'000'000U, 2'400'000U}) {
    const LimitedFiles limit(bytes);
    McapWriter writer(path_, "test");
    const McapId channel = writer.add_channel("/a", "json", writer.add_schema("A", "jsonschema", "{}"));
    const std::string large(600'000, 'x');
    try {
      for (int i = 0; i < 9; ++i) writer.write(channel, i, large);
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("free space on the disk and run again (what was written"),
                std::string::npos)
          << error.what();
    }
    EXPECT_THROW(writer.close(), std::runtime_error);
    const std::string file = bytes_of(path_);
    EXPECT_EQ(McapReader(file, false).messages.size(), 2U) << bytes;
    EXPECT_TRUE(ends_with_a_record(file)) << bytes;
  }
}

TEST_F(Mcap, AMessageOfAnUnknownChannelOrBeforeTimeZeroIsAMistakeOfTheCaller) {
  McapWriter writer(path_, "test");
  const McapId channel = writer.add_channel("/a", "json", writer.add_schema("A", "jsonschema", "{}"));
  EXPECT_THROW(writer.write(static_cast<McapId>(channel + 1), 0, "{}"), std::runtime_error);
  EXPECT_THROW(writer.write(channel, -1, "{}"), std::runtime_error);
}

// A run may pause, or its flight program hang, before it is killed.
TEST_F(Mcap, AMessageIsInTheFileASecondAfterItCameAtTheLatest) {
  McapWriter writer(path_, "test");
  const McapId channel =
      writer.add_channel("/first", "json", writer.add_schema("Number", "jsonschema", "{}"));
  writer.write(channel, 1, "1");
  writer.write_due();
  EXPECT_EQ(McapReader(bytes_of(path_), false).messages.size(), 0U);
  std::this_thread::sleep_for(std::chrono::milliseconds(1010));
  writer.write_due();
  EXPECT_EQ(McapReader(bytes_of(path_), false).messages.size(), 1U);
}

TEST_F(Mcap, IsWrittenByOneProgramAtATime) {
  McapWriter writer(path_, "test");
  writer.add_schema("A", "jsonschema", "{}");
  const std::string before = bytes_of(path_);
  EXPECT_THROW(McapWriter(path_, "other"), std::runtime_error);
  EXPECT_EQ(bytes_of(path_), before);
  writer.close();
  McapWriter(path_, "other").close();
  EXPECT_NE(bytes_of(path_), before);
}

}  // namespace
}  // namespace tumblesight::sim
