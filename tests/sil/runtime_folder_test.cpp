// Where the programs of a user meet, whatever other users do there.
#include "sim/sil/runtime_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "sim/sil/failure.hpp"
#include "sim/sil/run_announcement.hpp"
#include "sim/sil/run_control.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

const std::string kOfUser = "/tmp/tumblesight-" + std::to_string(geteuid());

class RuntimePlace : public testing::Test {
 protected:
  RuntimePlace() : given_(test::temporary_path("run")), folder_(given_ + "/tumblesight") {
    fs::create_directories(given_);
    fs::permissions(given_, fs::perms::owner_all);
    environment_.emplace("XDG_RUNTIME_DIR", given_);
  }
  void expect_refused(const std::string& reason) {
    try {
      const RuntimeFolder folder;
      ADD_FAILURE() << "not refused: " << reason;
    } catch (const SilFailure& failure) {
      for (const std::string& part : {folder_, reason, std::string("set XDG_RUNTIME_DIR")})
        EXPECT_NE(std::string(failure.what()).find(part), std::string::npos) << failure.what();
    }
    // A run goes on without it, and says why the console does not see it.
    const RunAnnouncement announcement(215, {});
    EXPECT_NE(announcement.failure().find(reason), std::string::npos) << announcement.failure();
    EXPECT_THROW(ask_run(215, "{}", 100), SilFailure);
    const RunControl control(215);
  }

  std::string given_, folder_;
  std::optional<test::Environment> environment_;
};

TEST_F(RuntimePlace, IsAPrivateFolderInThatOfTheUser) {
  EXPECT_EQ(RuntimeFolder().path_of("x"), folder_ + "/x");
  struct stat status {};
  ASSERT_EQ(stat(folder_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0700U);
}

TEST_F(RuntimePlace, DoesNotDependOnTheTemporaryFolder) {
  for (const char* given : {"", "relative", "/nonexistent", "/etc/passwd"}) {
    const test::Environment xdg("XDG_RUNTIME_DIR", given);
    for (const std::string& temporary : {std::string("/nonexistent"), given_}) {
      const test::Environment folder("TMPDIR", temporary);
      EXPECT_EQ(RuntimeFolder().path_of("x"), kOfUser + "/x") << given;
    }
  }
}

TEST_F(RuntimePlace, IsNotInAFolderThatOthersCanUse) {
  fs::permissions(given_, fs::perms::owner_all | fs::perms::group_read);
  EXPECT_EQ(RuntimeFolder().path_of("x"), kOfUser + "/x");
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder to another user";
  fs::permissions(given_, fs::perms::owner_all);
  ASSERT_EQ(chown(given_.c_str(), 65534, 65534), 0);
  EXPECT_EQ(RuntimeFolder().path_of("x"), kOfUser + "/x");
}

TEST_F(RuntimePlace, ThatOthersCanWriteToIsRefused) {
  fs::create_directory(folder_);
  for (const fs::perms others : {fs::perms::others_write, fs::perms::group_write}) {
    fs::permissions(folder_, fs::perms::owner_all | others);
    expect_refused("can be written by other users");
  }
}

TEST_F(RuntimePlace, OfAnotherUserIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder to another user";
  fs::create_directory(folder_);
  fs::permissions(folder_, fs::perms::owner_all);
  ASSERT_EQ(chown(folder_.c_str(), 65534, 65534), 0);
  expect_refused("belongs to another user (user id 65534)");
}

// As after a wrong umask or chmod.
TEST_F(RuntimePlace, ThatItsOwnerCannotUseIsRefusedWithTheRemedy) {
  fs::create_directory(folder_);
  if (geteuid() == 0) {  // whom no mode keeps out
    for (const std::string& path : {given_, folder_}) ASSERT_EQ(chown(path.c_str(), 65534, 65534), 0);
    ASSERT_EQ(seteuid(65534), 0);
  }
  for (const auto mode : {0500, 0300, 0600, 0000}) {
    EXPECT_EQ(chmod(folder_.c_str(), static_cast<mode_t>(mode)), 0);
    expect_refused("cannot be used: Permission denied; chmod 700 " + folder_);
  }
  if (getuid() == 0) ASSERT_EQ(seteuid(0), 0);
}

// None of them is waited for.
TEST_F(RuntimePlace, ThatIsNoFolderIsRefused) {
  ASSERT_EQ(mkfifo(folder_.c_str(), 0600), 0);
  expect_refused("is no folder");
  fs::remove(folder_);
  test::write_file(folder_, {});
  expect_refused("is no folder");
  fs::remove(folder_);
  const std::string elsewhere = test::temporary_path("elsewhere");
  fs::create_directory(elsewhere);
  fs::create_symlink(elsewhere, folder_);
  expect_refused("is no folder");
  EXPECT_TRUE(fs::is_empty(elsewhere));
  fs::remove(folder_);
  fs::create_symlink("/nonexistent", folder_);
  expect_refused("is no folder");
}

TEST_F(RuntimePlace, GivesOnlyRegularFilesOfTheUser) {
  const RuntimeFolder folder;
  const auto is_given = [&folder](const char* name) {
    const int file = folder.open_file(name);
    if (file >= 0) close(file);
    return file >= 0;
  };
  EXPECT_FALSE(is_given("file"));
  test::write_file(folder.path_of("file"), {'x'});
  EXPECT_TRUE(is_given("file"));
  ASSERT_EQ(mkfifo(folder.path_of("fifo").c_str(), 0600), 0);
  EXPECT_FALSE(is_given("fifo"));
  fs::create_symlink("file", folder.path_of("link"));
  EXPECT_FALSE(is_given("link"));
  fs::create_directory(folder.path_of("folder"));
  EXPECT_FALSE(is_given("folder"));
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a file to another user";
  ASSERT_EQ(chown(folder.path_of("file").c_str(), 65534, 65534), 0);
  EXPECT_FALSE(is_given("file"));
}

}  // namespace
}  // namespace tumblesight::sim
