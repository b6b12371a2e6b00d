// Verifies TS-RST-050.
#include "hal/posix/file_persistent_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace tumblesight::hal::posix {
namespace {

StoredBytes record(std::uint8_t seed) {
  StoredBytes bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(seed + 7 * i);
  return bytes;
}

class FilePersistentStoreTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::string path = folder.path("state");
};

TEST_F(FilePersistentStoreTest, KeepsBothCopiesForALaterProcess) {
  {
    FilePersistentStore store;
    ASSERT_TRUE(store.use(path.c_str()));
    StoredBytes bytes{};
    EXPECT_EQ(store.read(0, bytes), StoreStatus::kBlank);
    EXPECT_EQ(store.read(1, bytes), StoreStatus::kBlank);
    ASSERT_EQ(store.write(0, record(9)), StoreStatus::kOk);
    ASSERT_EQ(store.write(0, record(1)), StoreStatus::kOk);
    ASSERT_EQ(store.write(1, record(2)), StoreStatus::kOk);
  }
  FilePersistentStore store;
  ASSERT_TRUE(store.use(path.c_str()));
  for (const int copy : {0, 1}) {
    StoredBytes bytes{};
    ASSERT_EQ(store.read(copy, bytes), StoreStatus::kOk);
    EXPECT_EQ(bytes, record(static_cast<std::uint8_t>(copy + 1)));
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".new"));
}

TEST_F(FilePersistentStoreTest, FileInTheCurrentFolderIsWritten) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path(""));
  FilePersistentStore store;
  ASSERT_TRUE(store.use("state"));
  EXPECT_EQ(store.write(0, record(1)), StoreStatus::kOk);
  std::filesystem::current_path(before);
  EXPECT_TRUE(std::filesystem::exists(path));
}

// Verifies TS-RST-080.
TEST_F(FilePersistentStoreTest, FileOfAnotherSizeIsDamagedAndAnUnreadableOneIsNot) {
  FilePersistentStore store;
  ASSERT_TRUE(store.use(path.c_str()));
  StoredBytes bytes{};
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{kStoredBytes - 1}, std::size_t{kStoredBytes + 1}}) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << std::string(size, 'x');
    EXPECT_EQ(store.read(0, bytes), StoreStatus::kDamaged) << size;
  }
  std::filesystem::create_directory(path + ".copy");
  EXPECT_EQ(store.read(1, bytes), StoreStatus::kFailed);
}

TEST_F(FilePersistentStoreTest, FolderThatDoesNotExistFailsTheWrite) {
  FilePersistentStore store;
  ASSERT_TRUE(store.use(folder.path("none/state").c_str()));
  EXPECT_EQ(store.write(0, record(1)), StoreStatus::kFailed);
  EXPECT_FALSE(store.use(std::string(FilePersistentStore::kMaxPath, 'a').c_str()));
}

TEST_F(FilePersistentStoreTest, FailedWriteLeavesTheOldRecord) {
  FilePersistentStore store;
  ASSERT_TRUE(store.use(path.c_str()));
  ASSERT_EQ(store.write(0, record(1)), StoreStatus::kOk);
  std::filesystem::create_directory(path + ".new");  // the temporary file cannot be created
  EXPECT_EQ(store.write(0, record(2)), StoreStatus::kFailed);
  StoredBytes bytes{};
  ASSERT_EQ(store.read(0, bytes), StoreStatus::kOk);
  EXPECT_EQ(bytes, record(1));
}

constexpr std::array<std::uint8_t, FilePersistentStore::kMagicBytes> kMagic{'T', 'S', 'S', 'T'};

// Verifies TS-RST-060.
TEST_F(FilePersistentStoreTest, OnlyRecordsAndNewFilesAreUsable) {
  FilePersistentStore store;
  ASSERT_TRUE(store.use(path.c_str()));
  EXPECT_EQ(store.check(kMagic).status, StoreFileStatus::kUsable);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path("")));
  StoredBytes good = record(1);
  std::copy(kMagic.begin(), kMagic.end(), good.begin());
  for (const char* const end : {"", ".copy"}) {
    for (const int copy : {0, 1}) ASSERT_EQ(store.write(copy, good), StoreStatus::kOk);
    EXPECT_EQ(store.check(kMagic).status, StoreFileStatus::kUsable);
    for (const int size : {0, 1, kStoredBytes - 1, kStoredBytes, kStoredBytes + 1}) {
      std::ofstream(path + end, std::ios::trunc) << std::string(static_cast<std::size_t>(size), 'x');
      const StoreFileCheck result = store.check(kMagic);
      EXPECT_EQ(result.status, StoreFileStatus::kNotARecord) << size;
      EXPECT_EQ(result.path, path + end);
    }
  }
}

// Verifies TS-RST-060. The application reads what it can, and the other copy.
TEST_F(FilePersistentStoreTest, ShortRecordsAreUsable) {
  FilePersistentStore store;
  ASSERT_TRUE(store.use(path.c_str()));
  StoredBytes good = record(1);
  std::copy(kMagic.begin(), kMagic.end(), good.begin());
  for (const int copy : {0, 1}) ASSERT_EQ(store.write(copy, good), StoreStatus::kOk);
  for (const int size : {static_cast<int>(kMagic.size()), 128, kStoredBytes - 1}) {
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(size));
    EXPECT_EQ(store.check(kMagic).status, StoreFileStatus::kUsable) << size;
    StoredBytes bytes{};
    EXPECT_EQ(store.read(0, bytes), StoreStatus::kDamaged) << size;
  }
}

// Verifies TS-RST-060.
TEST_F(FilePersistentStoreTest, LinksFoldersAndMissingFoldersAreNotUsable) {
  FilePersistentStore store;
  for (const char* const end : {"", ".copy", ".new", ".copy.new"}) {
    ASSERT_TRUE(store.use(path.c_str()));
    std::filesystem::create_symlink(folder.path("target"), path + end);
    EXPECT_EQ(store.check(kMagic).status, StoreFileStatus::kNotARegularFile) << end;
    std::filesystem::remove(path + end);
    std::filesystem::create_directory(path + end);
    EXPECT_EQ(store.check(kMagic).status, StoreFileStatus::kNotARegularFile) << end;
    std::filesystem::remove(path + end);
  }
  ASSERT_TRUE(store.use(folder.path("none/state").c_str()));
  EXPECT_EQ(store.check(kMagic).status, StoreFileStatus::kFailed);
  EXPECT_EQ(store.check(kMagic).error, ENOENT);
}

// Verifies TS-RST-060.
TEST_F(FilePersistentStoreTest, KnowsItsOwnFiles) {
  FilePersistentStore store;
  ASSERT_TRUE(store.use(path.c_str()));
  for (const char* const end : {"", ".copy", ".new", ".copy.new"})
    EXPECT_TRUE(store.uses((path + end).c_str()));
  EXPECT_TRUE(store.uses(folder.path("./state").c_str()));
  EXPECT_FALSE(store.uses((path + ".bin").c_str()));
  ASSERT_EQ(store.write(0, record(1)), StoreStatus::kOk);
  std::filesystem::create_hard_link(path, folder.path("other"));
  EXPECT_TRUE(store.uses(folder.path("other").c_str()));
}

}  // namespace
}  // namespace tumblesight::hal::posix
