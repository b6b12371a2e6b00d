// Verifies TS-TRN-110.
// `train --ranks` as a user runs it: one rank that is killed ends all, and the run is continued to the same
// image.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "sim/training/join_ranks.hpp"
#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr char kTraining[] =
    "train --cnn-images 384 --rcnn-sequences 16 --rcnn-iterations 3 --checkpoint-seconds 0 --workers 1 "
    "--out ";

bool wait_until(const std::function<bool()>& condition) {
  const auto deadline = Clock::now() + std::chrono::seconds(60);
  while (!condition() && Clock::now() < deadline) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return condition();
}

// The process that was started as this rank; 0: it does not run yet.
pid_t process_of_rank(pid_t supervisor, int rank) {
  const std::string own = "TUMBLESIGHT_RANK=" + std::to_string(rank);
  const std::string id = std::to_string(supervisor);
  std::ifstream children("/proc/" + id + "/task/" + id + "/children");
  for (pid_t child = 0; children >> child;) {
    const std::string environment = content("/proc/" + std::to_string(child) + "/environ");
    if (environment.rfind(own + '\0', 0) == 0) return child;
  }
  return 0;
}

// Adopted by a process that does not wait for it.
bool is_zombie(pid_t process) {
  const std::string status = content("/proc/" + std::to_string(process) + "/stat");
  return status.find(") Z ") != std::string::npos;
}

class LocalRanks : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_have_several_ranks()) GTEST_SKIP() << "built without Gloo";
  }

  // The shell becomes the program, so that the process is the supervisor.
  pid_t start(const std::string& arguments, const std::string& variable = "") const {
    const std::string line = "cd " + here.path("") + " && exec env " + variable + " " + TUMBLESIGHT_BINARY +
                             " " + arguments + " >run.out 2>run.err </dev/null";
    const char* words[] = {"sh", "-c", line.c_str(), nullptr};
    pid_t child = -1;
    EXPECT_EQ(posix_spawn(&child, "/bin/sh", nullptr, nullptr, const_cast<char**>(words), environ), 0);
    return child;
  }
  static int wait_for(pid_t child) {
    int status = -1;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const Workplace here;
};

TEST_F(LocalRanks, EndWithOneThatIsKilledAndAreContinuedToTheSameImage) {
  const pid_t supervisor = start(std::string(kTraining) + "killed --ranks 2");
  ASSERT_TRUE(wait_until([&] { return fs::exists(here.path("killed/cnn.ckpt")); }));
  kill(process_of_rank(supervisor, 1), SIGKILL);
  const auto killed = Clock::now();
  EXPECT_EQ(wait_for(supervisor), kFailed);
  EXPECT_LT(Clock::now() - killed, std::chrono::seconds(5));
  const std::string errors = content(here.path("run.err"));
  EXPECT_NE(errors.find("rank 1 (process "), std::string::npos) << errors;
  EXPECT_NE(errors.find("was ended by signal 9 (Killed)"), std::string::npos) << errors;
  EXPECT_NE(errors.find("The same command continues from the last checkpoint"), std::string::npos) << errors;
  EXPECT_FALSE(fs::exists(here.path("killed/near_shoemaker.tsm")));
  ASSERT_EQ(wait_for(start(std::string(kTraining) + "killed --ranks 2")), 0);
  EXPECT_GT(content(here.path("killed/near_shoemaker.tsm")).size(), 900'000U);
  const std::string image = content(here.path("killed/near_shoemaker.float32.tsm"));
  EXPECT_GT(image.size(), 3'000'000U);

  // A run that is not interrupted before it has written this image; the other one takes longer.
  const pid_t through = start(std::string(kTraining) + "through --ranks 2");
  const std::string again = here.path("through/near_shoemaker.float32.tsm");
  ASSERT_TRUE(wait_until([&] { return fs::exists(again) && fs::file_size(again) == image.size(); }));
  kill(process_of_rank(through, 0), SIGKILL);
  wait_for(through);
  EXPECT_TRUE(image == content(again));
}

TEST_F(LocalRanks, EndWithTheirSupervisorAndLeaveNothingBehind) {
  fs::create_directory(here.path("tmp"));
  const pid_t supervisor = start(
      "train --cnn-images 1000000 --checkpoint-seconds 0 --workers 1 --ranks 2 --out left", "TMPDIR=tmp");
  ASSERT_TRUE(wait_until([&] { return fs::exists(here.path("left/cnn.ckpt")); }));
  const pid_t ranks[] = {process_of_rank(supervisor, 0), process_of_rank(supervisor, 1)};
  kill(supervisor, SIGKILL);
  wait_for(supervisor);
  for (const pid_t rank : ranks) {
    ASSERT_NE(rank, 0);
    EXPECT_TRUE(wait_until([&] { return kill(rank, 0) != 0 || is_zombie(rank); })) << rank;
  }
  EXPECT_TRUE(fs::is_empty(here.path("tmp")));
}

// As one whose supervisor is killed while it starts. It must not wait for the others until --rank-timeout.
TEST_F(LocalRanks, ARankThatHasNoSupervisorEndsBeforeItFindsTheOthers) {
  const pid_t rank = start(std::string(kTraining) + "alone --rank-timeout 3600",
                           "TUMBLESIGHT_RANK=0 TUMBLESIGHT_RANKS=2 TUMBLESIGHT_RANK_STORE=store "
                           "TUMBLESIGHT_STARTER=1");
  int status = 0;
  pid_t ended = 0;
  EXPECT_TRUE(wait_until([&] { return ended == rank || (ended = waitpid(rank, &status, WNOHANG)) == rank; }));
  EXPECT_TRUE(WIFSIGNALED(status)) << status;
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
  EXPECT_NE(content(here.path("run.err")).find("the process that started this one has ended"),
            std::string::npos);
}

TEST_F(LocalRanks, StopBeforeTheyHaveFoundEachOther) {
  const pid_t supervisor = start(std::string(kTraining) + "early --ranks 2");
  ASSERT_TRUE(wait_until([&] { return process_of_rank(supervisor, 1) != 0; }));
  kill(process_of_rank(supervisor, 1), SIGSTOP);  // so that rank 0 waits for it
  kill(supervisor, SIGTERM);
  EXPECT_EQ(wait_for(supervisor), kStopped);
  EXPECT_NE(content(here.path("run.out")).find("Stopped before the ranks had found each other"),
            std::string::npos);
}

TEST_F(LocalRanks, StopTogetherWithACheckpoint) {
  const pid_t supervisor =
      start("train --cnn-images 1000000 --checkpoint-seconds 0 --workers 1 --ranks 2 --out stopped");
  ASSERT_TRUE(wait_until([&] { return fs::exists(here.path("stopped/cnn.ckpt")); }));
  kill(process_of_rank(supervisor, 1), SIGTERM);
  EXPECT_EQ(wait_for(supervisor), kStopped);
  const std::string output = content(here.path("run.out"));
  const std::size_t told = output.find("The same command continues from the checkpoint in stopped");
  ASSERT_NE(told, std::string::npos) << output;
  EXPECT_EQ(output.find("The same command", told + 1), std::string::npos) << "by one rank only";
}

TEST_F(LocalRanks, ThatDoNotDivideTheBatchAreRefused) {
  for (const char* arguments : {"--ranks 3", "--ranks 16 --trainers 8"}) {
    const Outcome outcome = here.run(std::string(kTraining) + "refused " + arguments);
    EXPECT_EQ(outcome.exit_code, kBadArguments) << arguments;
    EXPECT_NE(outcome.errors.find("do not divide a batch of 64"), std::string::npos) << outcome.errors;
  }
  EXPECT_EQ(here.run(std::string(kTraining) + "refused --ranks 0").exit_code, kBadArguments);
  EXPECT_FALSE(fs::exists(here.path("refused")));
}

TEST_F(LocalRanks, AreNotStartedByARankOfALauncher) {
  const Outcome outcome = here.run_command(
      std::string("RANK=0 WORLD_SIZE=2 ") + TUMBLESIGHT_BINARY + " " + kTraining + "refused --ranks 4",
      "run");
  EXPECT_EQ(outcome.exit_code, kBadArguments);
  EXPECT_NE(outcome.errors.find("was started as one of 2 ranks"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace tumblesight::sim
