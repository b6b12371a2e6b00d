#include "sim/host/end_with_starter.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>

namespace tumblesight::sim {
namespace {

constexpr int kSurvived = 5, kNotAllowed = 6;
constexpr unsigned kLongest_s = 10;

int status_of(pid_t process) {
  int status = -1;
  EXPECT_EQ(waitpid(process, &status, 0), process);
  return status;
}

// Runs `child` in a child of another process, and returns how it ends. The other process, its starter, ends
// when it calls `release`. We adopt it.
int status_of_orphan(const std::function<void(const std::function<void()>& release)>& child) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t starter = fork();
  if (starter == 0) {
    std::string environment = starter_environment();
    int pipe_ends[2];
    char byte = 0;
    if (pipe(pipe_ends) != 0) _exit(1);
    if (fork() != 0) _exit(read(pipe_ends[0], &byte, 1) == 1 ? 0 : 1);
    alarm(kLongest_s);
    putenv(environment.data());
    const pid_t own_starter = getppid();
    child([&] {
      if (write(pipe_ends[1], &byte, 1) != 1) _exit(1);
      while (getppid() == own_starter) usleep(1000);
    });
    _exit(kSurvived);
  }
  EXPECT_EQ(status_of(starter), 0);
  int status = -1;
  EXPECT_GT(waitpid(-1, &status, 0), 0);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
  return status;
}

TEST(EndWithStarter, EndsAProcessWhoseStarterEndsLater) {
  const int status = status_of_orphan([](const auto& release) {
    end_with_starter();
    release();
    pause();
  });
  ASSERT_TRUE(WIFSIGNALED(status)) << "exit status " << WEXITSTATUS(status);
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

TEST(EndWithStarter, EndsAProcessWhoseStarterHasEndedBefore) {
  const int status = status_of_orphan([](const auto& release) {
    release();
    end_with_starter();
  });
  ASSERT_TRUE(WIFSIGNALED(status)) << "exit status " << WEXITSTATUS(status);
  EXPECT_EQ(WTERMSIG(status), SIGTERM);
}

TEST(EndWithStarter, LeavesAProcessWhoseStarterLives) {
  std::string environment = starter_environment();
  const pid_t child = fork();
  if (child == 0) {
    putenv(environment.data());
    end_with_starter();
    _exit(kSurvived);
  }
  const int status = status_of(child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kSurvived);
}

// As a worker that mpirun has started, which is told nothing.
TEST(EndWithStarter, LeavesAProcessThatDoesNotKnowItsStarter) {
  const pid_t child = fork();
  if (child == 0) {
    unsetenv("TUMBLESIGHT_STARTER");
    end_with_starter();
    _exit(kSurvived);
  }
  const int status = status_of(child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kSurvived);
}

// mpirun or a batch script as the first process of a container.
TEST(EndWithStarter, LeavesAProcessWhoseStarterIsProcessOne) {
  const pid_t namespace_of_its_own = fork();
  if (namespace_of_its_own == 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWPID) != 0) _exit(kNotAllowed);
    const pid_t first = fork();
    if (first == 0) {
      const pid_t worker = fork();
      if (worker == 0) {
        if (getppid() != 1) _exit(1);
        unsetenv("TUMBLESIGHT_STARTER");
        end_with_starter();
        _exit(kSurvived);
      }
      int status = -1;
      waitpid(worker, &status, 0);
      _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
    }
    int status = -1;
    waitpid(first, &status, 0);
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
  }
  const int status = status_of(namespace_of_its_own);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNotAllowed) GTEST_SKIP() << "no namespace may be made here";
  EXPECT_EQ(WEXITSTATUS(status), kSurvived);
}

}  // namespace
}  // namespace tumblesight::sim
