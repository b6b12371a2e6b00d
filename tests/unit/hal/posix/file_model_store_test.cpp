// Verifies TS-IFC-070.
#include "hal/posix/file_model_store.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace tumblesight::hal::posix {
namespace {

class FileModelStoreTest : public ::testing::Test {
 protected:
  FileModelStoreTest() {
    std::string name = ::testing::TempDir() + "model_store_XXXXXX";
    folder_ = mkdtemp(name.data());
  }
  ~FileModelStoreTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string write(const std::string& name, std::size_t size) const {
    std::ofstream file(path(name), std::ios::binary);
    for (std::size_t i = 0; i < size; ++i) file.put(static_cast<char>(i * 7));
    return path(name);
  }
  static void expect_none(const std::string& path, FileStatus status, std::size_t max_bytes = 4096) {
    FileModelStore store(path.c_str(), max_bytes);
    EXPECT_EQ(store.status(), status) << to_string(store.status());
    EXPECT_EQ(store.bank(0).size, 0U);
    EXPECT_EQ(store.bank(1).size, 0U);
  }

  std::string folder_;
};

TEST_F(FileModelStoreTest, HoldsTheWholeFileAndKeepsItWhenTheFileChanges) {
  const std::string name = write("model.tsm", 4096);
  FileModelStore store(name.c_str(), 4096);
  ASSERT_EQ(store.status(), FileStatus::kOk);
  std::ofstream(name, std::ios::binary | std::ios::trunc) << "something else";
  for (const int index : {0, 1}) {
    const ModelBank bank = store.bank(index);
    ASSERT_EQ(bank.size, 4096U);
    ASSERT_EQ(bank.capacity, 4096U);
    for (std::size_t i = 0; i < bank.size; ++i)
      ASSERT_EQ(bank.data[i], static_cast<std::uint8_t>(i * 7)) << i;
  }
}

TEST_F(FileModelStoreTest, BanksAreIndependent) {
  FileModelStore store(write("model.tsm", 4096).c_str(), 4096);
  const std::uint8_t byte = store.bank(1).data[4095] ^ 1;
  EXPECT_EQ(store.write(1, 4095, &byte, 1), WriteStatus::kAccepted);
  EXPECT_EQ(store.bank(1).data[4095], byte);
  EXPECT_EQ(store.activity(1), BankActivity::kReady);
  EXPECT_NE(store.bank(0).data[4095], store.bank(1).data[4095]);
  EXPECT_NE(store.bank(0).data, store.bank(1).data);
}

TEST_F(FileModelStoreTest, BytesBeyondTheBankAreRefused) {
  FileModelStore store(write("model.tsm", 10).c_str(), 10);
  const std::uint8_t bytes[11] = {};
  EXPECT_EQ(store.write(0, 0, bytes, 11), WriteStatus::kRefused);
  EXPECT_EQ(store.write(0, 8, bytes, 3), WriteStatus::kRefused);
  EXPECT_EQ(store.write(0, 0xFFFFFFFF, bytes, 3), WriteStatus::kRefused);
  EXPECT_EQ(store.write(0, 8, bytes, 2), WriteStatus::kAccepted);
  EXPECT_EQ(write_at_once(nullptr, 10, 0, bytes, 1), WriteStatus::kRefused);
}

TEST_F(FileModelStoreTest, MissingFileIsReported) {
  expect_none(path("none.tsm"), FileStatus::kMissing);
  expect_none(write("file", 1) + "/below_a_file", FileStatus::kMissing);
}

TEST_F(FileModelStoreTest, LargerFileThanAllowedIsRefused) {
  expect_none(write("large.tsm", 4097), FileStatus::kTooLarge);
}

TEST_F(FileModelStoreTest, EmptyFileIsRefused) {
  expect_none(write("empty.tsm", 0), FileStatus::kEmpty);
}

TEST_F(FileModelStoreTest, NonRegularFileIsUnreadable) {
  expect_none(folder_, FileStatus::kUnreadable);
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  expect_none(path("pipe"), FileStatus::kUnreadable);
}

TEST_F(FileModelStoreTest, ForbiddenFileIsUnreadable) {
  const std::string name = write("secret.tsm", 10);
  ASSERT_EQ(chmod(name.c_str(), 0), 0);
  if (access(name.c_str(), R_OK) == 0) GTEST_SKIP() << "this user may read everything";
  expect_none(name, FileStatus::kUnreadable);
}

TEST(FileStatusText, EveryStatusHasItsOwnText) {
  std::vector<std::string> words;
  for (int i = 0; i <= static_cast<int>(FileStatus::kNoMemory); ++i) {
    words.emplace_back(to_string(static_cast<FileStatus>(i)));
    EXPECT_NE(words.back(), "unknown");
  }
  std::sort(words.begin(), words.end());
  EXPECT_EQ(std::adjacent_find(words.begin(), words.end()), words.end());
}

}  // namespace
}  // namespace tumblesight::hal::posix
