// How the console finds a run, and that nobody else does.
#include "sim/sil/run_announcement.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

#include "sim/sil/domain_lease.hpp"
#include "sim/sil/runtime_folder.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

class Announcement : public testing::Test {
 protected:
  Announcement() {
    EXPECT_TRUE(hal::dds::make_run_secret(secret_));
    lease_.emplace(test::spare_domain());
    path_ = RuntimeFolder().path_of("domain-" + std::to_string(lease_->domain()) + ".run");
  }
  int domain() const { return static_cast<int>(lease_->domain()); }

  hal::dds::RunSecret secret_;
  std::optional<DomainLease> lease_;
  std::string path_;
};

TEST_F(Announcement, TellsItsOwnerAlone) {
  const RunAnnouncement announcement(lease_->domain(), secret_);
  const std::optional<AnnouncedRun> run = announced_run(domain());
  ASSERT_TRUE(run);
  EXPECT_EQ(run->domain, lease_->domain());
  EXPECT_EQ(run->secret.run_id, secret_.run_id);
  EXPECT_STREQ(run->secret.partition, secret_.partition);
  struct stat status {};
  ASSERT_EQ(stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  EXPECT_TRUE(announced_run(-1));
}

TEST_F(Announcement, OfTheDefaultPartitionHasNoName) {
  secret_.partition[0] = '\0';
  const RunAnnouncement announcement(lease_->domain(), secret_);
  const std::optional<AnnouncedRun> run = announced_run(domain());
  ASSERT_TRUE(run);
  EXPECT_EQ(run->secret.run_id, secret_.run_id);
  EXPECT_STREQ(run->secret.partition, "");
}

TEST_F(Announcement, EndsWithTheRun) {
  { const RunAnnouncement announcement(lease_->domain(), secret_); }
  EXPECT_FALSE(announced_run(domain()));
}

// It could not remove its file. The next run has the domain, and has not announced itself yet.
TEST_F(Announcement, OfAKilledRunIsNotTakenForTheNextRun) {
  test::leave_announcement_of_killed_run(domain());
  ASSERT_TRUE(std::filesystem::exists(path_));
  EXPECT_FALSE(announced_run(domain()));
  const RunAnnouncement announcement(lease_->domain(), secret_);
  const std::optional<AnnouncedRun> run = announced_run(domain());
  ASSERT_TRUE(run);
  EXPECT_EQ(run->secret.run_id, secret_.run_id);
}

// In a folder that only the user can write to, so by the user's own mistake. The console does not wait for
// it.
TEST_F(Announcement, WhoseNameIsTakenByAFifoOrALinkIsMadeAllTheSame) {
  const std::string elsewhere = test::temporary_path("elsewhere");
  for (const bool is_fifo : {true, false}) {
    if (is_fifo) {
      ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
    } else {
      std::filesystem::create_symlink(elsewhere, path_);
    }
    EXPECT_FALSE(announced_run(domain()));
    const RunAnnouncement announcement(lease_->domain(), secret_);
    EXPECT_EQ(announcement.failure(), "");
    EXPECT_TRUE(announced_run(domain()));
    EXPECT_FALSE(std::filesystem::exists(elsewhere));
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(Announcement, WhoseNameIsTakenByAFolderIsMissedWithTheReason) {
  ASSERT_EQ(mkdir(path_.c_str(), 0700), 0);
  EXPECT_FALSE(announced_run(domain()));
  {
    const RunAnnouncement announcement(lease_->domain(), secret_);
    EXPECT_NE(announcement.failure().find(path_ + " cannot be written"), std::string::npos)
        << announcement.failure();
    EXPECT_FALSE(announced_run(domain()));
  }
  EXPECT_TRUE(std::filesystem::remove(path_));
}

TEST_F(Announcement, OfAnotherUserIsIgnored) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a file to another user";
  const std::string text = to_text(secret_).text;
  test::write_file(path_, {text.begin(), text.end()});
  const int file = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(file, LOCK_EX | LOCK_NB), 0);
  EXPECT_TRUE(announced_run(domain()));
  ASSERT_EQ(chown(path_.c_str(), 65534, 65534), 0);
  EXPECT_FALSE(announced_run(domain()));
  close(file);
  std::filesystem::remove(path_);
}

// The file of a run in another network namespace may have the same name.
TEST_F(Announcement, RemovesNoFileButItsOwn) {
  std::optional<RunAnnouncement> first(std::in_place, lease_->domain(), secret_);
  const RunAnnouncement second(lease_->domain(), secret_);
  first.reset();
  EXPECT_TRUE(announced_run(domain()));
}

// As a simulator locks its own.
class Locked {
 public:
  explicit Locked(const std::string& path) : file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    EXPECT_EQ(flock(file_, LOCK_EX | LOCK_NB), 0) << path;
  }
  ~Locked() { close(file_); }
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  int file_;
};

TEST_F(Announcement, ThatIsDamagedIsIgnored) {
  for (const std::string text :
       {"", "x", "12", "12:xyz", ":", "99999999999:0123456789abcdef0123456789abcdef"}) {
    test::write_file(path_, {text.begin(), text.end()});
    const Locked by_its_run(path_);
    EXPECT_FALSE(announced_run(domain())) << text;
  }
  std::filesystem::remove(path_);
}

TEST_F(Announcement, ThatIsALinkIsIgnored) {
  const std::string elsewhere = test::temporary_path("elsewhere");
  const std::string text = to_text(secret_).text;
  test::write_file(elsewhere, {text.begin(), text.end()});
  const Locked by_its_run(elsewhere);
  std::filesystem::create_symlink(elsewhere, path_);
  EXPECT_FALSE(announced_run(domain()));
  // Without the link it would be taken.
  std::filesystem::remove(path_);
  std::filesystem::create_hard_link(elsewhere, path_);
  EXPECT_TRUE(announced_run(domain()));
  std::filesystem::remove(path_);
}

}  // namespace
}  // namespace tumblesight::sim
