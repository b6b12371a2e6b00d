#include "sim/host/place.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "sim/host/write_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

constexpr uid_t kOwn = 65533, kOther = 65534;

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string refusal_of(const std::string& path) {
  try {
    write_file(path, "led astray");
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

// A user with a file of their own, and a folder in which another user has put something. Only root can make
// it.
class PlaceOfAnother : public testing::Test {
 protected:
  void SetUp() override {
    if (geteuid() != 0) GTEST_SKIP() << "only root can make files of another user";
    ASSERT_EQ(chmod(top_.path("").c_str(), 0755), 0);
    make_folder(own_folder_, kOwn, 0755);
    std::ofstream(precious_) << "precious";
    give(precious_, kOwn);
  }
  void TearDown() override {
    if (geteuid() != 0) (void)seteuid(0);
  }
  static void give(const std::string& path, uid_t user) { ASSERT_EQ(lchown(path.c_str(), user, user), 0); }
  static void make_folder(const std::string& path, uid_t user, mode_t mode) {
    ASSERT_EQ(mkdir(path.c_str(), 0700), 0);
    ASSERT_EQ(chmod(path.c_str(), mode), 0);
    give(path, user);
  }
  static void make_link(const std::string& to, const std::string& path, uid_t user) {
    std::filesystem::create_symlink(to, path);
    give(path, user);
  }
  static void become(uid_t user) { ASSERT_EQ(seteuid(user), 0); }

  TemporaryFolder top_;
  const std::string own_folder_ = top_.path("own"), precious_ = top_.path("own/precious");
  const std::string shared_ = top_.path("shared");
};

TEST_F(PlaceOfAnother, LinkIsNotFollowedWhoeverOwnsItsFolder) {
  int count = 0;
  for (const uid_t owner : {uid_t{0}, kOwn, kOther}) {
    for (const mode_t mode : {01777, 0777, 0755}) {
      const std::string folder = shared_ + std::to_string(++count);
      make_folder(folder, owner, mode);
      make_link(precious_, folder + "/link", kOther);
      become(kOwn);
      EXPECT_NE(refusal_of(folder + "/link").find("link of another user"), std::string::npos)
          << owner << ' ' << mode;
      EXPECT_NE(fault_of_place(folder + "/link"), "");
      become(0);
    }
  }
  EXPECT_EQ(text_of(precious_), "precious");
}

TEST_F(PlaceOfAnother, LinkIsNotFollowedAsAFolderOfThePath) {
  make_folder(shared_, 0, 01777);
  make_link(own_folder_, shared_ + "/results", kOther);
  make_link(shared_ + "/results", top_.path("own/way"), kOwn);
  become(kOwn);
  for (const std::string& path :
       {shared_ + "/results/precious", shared_ + "/results/new/deep/file", top_.path("own/way/precious"),
        shared_ + "/../shared/results/../own/precious"}) {
    EXPECT_NE(refusal_of(path).find("'results' of its path is a link of another user"), std::string::npos)
        << path;
    EXPECT_NE(fault_of_place(path), "") << path;
  }
  become(0);
  EXPECT_EQ(text_of(precious_), "precious");
  EXPECT_FALSE(std::filesystem::exists(own_folder_ + "/new")) << "no folder is made behind the link either";
}

TEST_F(PlaceOfAnother, PipeIsRefusedInEveryFolder) {
  int count = 0;
  for (const mode_t mode : {01777, 0777, 0755}) {
    const std::string folder = shared_ + std::to_string(++count), pipe = folder + "/pipe";
    make_folder(folder, kOther, mode);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0666), 0);
    ASSERT_EQ(chmod(pipe.c_str(), 0666), 0);
    give(pipe, kOther);
    become(kOwn);
    EXPECT_NE(refusal_of(pipe).find("pipe of another user"), std::string::npos) << mode;
    become(0);
    EXPECT_NE(fault_of_place(pipe).find("pipe of another user"), std::string::npos) << "for root as well";
  }
}

TEST_F(PlaceOfAnother, OwnLinksAndThoseOfRootAreFollowed) {
  make_folder(shared_, kOther, 01777);
  make_link(own_folder_, shared_ + "/of_root", 0);
  make_link("of_root/precious", shared_ + "/own_link", kOwn);
  become(kOwn);
  EXPECT_EQ(refusal_of(shared_ + "/own_link"), "");
  EXPECT_EQ(refusal_of(shared_ + "/of_root/deep/file"), "");
  become(0);
  EXPECT_EQ(text_of(precious_), "led astray");
  EXPECT_EQ(text_of(own_folder_ + "/deep/file"), "led astray");
}

// A container's root, in a project folder of the user outside it.
TEST_F(PlaceOfAnother, RootFollowsTheLinkOfTheOneWhoAloneMayWriteToItsFolder) {
  make_link(precious_, own_folder_ + "/link", kOwn);
  for (const mode_t mode : {01755, 0777, 0775, 01777}) {
    ASSERT_EQ(chmod(own_folder_.c_str(), mode), 0);
    const bool is_followed = (mode & 022) == 0;
    EXPECT_EQ(refusal_of(own_folder_ + "/link").empty(), is_followed) << mode;
    EXPECT_EQ(text_of(precious_), "led astray") << "written the first time";
  }
}

// Between the look before the run and the writing after it.
TEST_F(PlaceOfAnother, WhatIsPutThereMeanwhileIsNotWritten) {
  make_folder(shared_, 0, 01777);
  const std::string path = shared_ + "/file";
  become(kOwn);
  const Place place(path);
  ASSERT_EQ(place.fault(), "");
  become(0);
  make_link(precious_, path, kOther);
  become(kOwn);
  EXPECT_THROW(open_place(place), std::runtime_error);
  become(0);
  ASSERT_EQ(unlink(path.c_str()), 0);
  ASSERT_EQ(mkfifo(path.c_str(), 0666), 0);
  ASSERT_EQ(chmod(path.c_str(), 0666), 0);
  give(path, kOther);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  become(kOwn);
  EXPECT_THROW(open_place(place), std::runtime_error);
  become(0);
  close(reader);
  EXPECT_EQ(text_of(precious_), "precious");
}

// The folder of the path is held: another one under its name is not written to.
TEST_F(PlaceOfAnother, FolderThatIsExchangedMeanwhileIsNotWritten) {
  make_folder(shared_, kOther, 0777);
  make_folder(shared_ + "/results", kOther, 0777);
  const Place place(shared_ + "/results/precious");
  ASSERT_EQ(place.fault(), "");
  ASSERT_EQ(rename((shared_ + "/results").c_str(), (shared_ + "/old").c_str()), 0);
  make_link(own_folder_, shared_ + "/results", kOther);
  const int file = open_place(place);
  EXPECT_EQ(write(file, "x", 1), 1);
  close(file);
  EXPECT_EQ(text_of(precious_), "precious");
  EXPECT_EQ(text_of(shared_ + "/old/precious"), "x");
}

TEST(Place, DevicesAndOpenFilesAreTakenAsTheyAre) {
  for (const char* path : {"/dev/stdout", "/dev/null", "/dev/fd/1", "/proc/self/fd/1", "/proc/self/cwd/file"})
    EXPECT_EQ(Place(path).fault(), "") << path;
  EXPECT_TRUE(Place("/dev/stdout").is_of_kernel());
  EXPECT_EQ(Place("/dev/null").type(), mode_t{S_IFCHR});
  write_file("/dev/null", "nothing");
  EXPECT_EQ(fault_of_place("/dev/null"), "");
  EXPECT_EQ(Place("/no/such/folder/file").fault(), "") << "it leads nowhere yet";
}

// As `--json >(program)` of a shell: a descriptor of a pipe.
TEST(Place, DescriptorOfAPipeIsWritten) {
  int ends[2] = {};
  ASSERT_EQ(pipe(ends), 0);
  const std::string path = "/dev/fd/" + std::to_string(ends[1]);
  EXPECT_EQ(fault_of_place(path), "");
  write_file(path, "content");
  char text[7] = {};
  EXPECT_EQ(read(ends[0], text, sizeof text), 7);
  EXPECT_EQ(std::string(text, sizeof text), "content");
  close(ends[0]);
  close(ends[1]);
}

// As `tool --json /dev/stdout >file`: the file stays the one that the shell has opened.
TEST(Place, OpenFileIsWrittenAndNotReplaced) {
  const TemporaryFolder folder;
  const std::string path = folder.path("file");
  const int file = open(path.c_str(), O_RDWR | O_CREAT, 0600);
  write_file("/proc/self/fd/" + std::to_string(file), "content");
  char text[8] = {};
  EXPECT_EQ(pread(file, text, sizeof text, 0), 7);
  close(file);
}

TEST(Place, PipeThatNobodyReadsIsRefusedAtOnce) {
  const TemporaryFolder folder;
  const std::string path = folder.path("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(fault_of_place(path), "nobody reads this pipe; start its reader first, or give a file");
  EXPECT_NE(refusal_of(path).find(path + "': nobody reads this pipe"), std::string::npos);
}

// The look before the run must not be the end of the content for the reader.
TEST(Place, ReaderOfAPipeWaitsForTheContent) {
  const TemporaryFolder folder;
  const std::string path = folder.path("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  EXPECT_EQ(fault_of_place(path), "");
  char text[8] = {};
  EXPECT_EQ(read(reader, text, sizeof text), -1) << "0 would be the end";
  write_file(path, "content");
  EXPECT_EQ(read(reader, text, sizeof text), 7);
  close(reader);
}

TEST(Place, TooManyLinksAreToldAsSuch) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("b", folder.path("a"));
  std::filesystem::create_symlink("a", folder.path("b"));
  EXPECT_EQ(Place(folder.path("a")).fault(), "its path has too many links; give another path");
}

}  // namespace
}  // namespace tumblesight::sim
