#include "hal/dds/idl/machine_name.hpp"

#include <errno.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

namespace tumblesight::hal::dds {
namespace {

std::string name_of_this_test() {
  return "tumblesight-test-name-" + std::to_string(getpid());
}

TEST(MachineName, HasOneHolderUntilItIsReleased) {
  MachineName first, second;
  ASSERT_EQ(first.hold(name_of_this_test().c_str()), 0);
  EXPECT_EQ(second.hold(name_of_this_test().c_str()), EADDRINUSE);
  EXPECT_EQ(second.descriptor(), -1);
  first.release();
  EXPECT_EQ(second.hold(name_of_this_test().c_str()), 0);
}

TEST(MachineName, ThatIsTooLongIsRefused) {
  MachineName name;
  EXPECT_EQ(name.hold(std::string(MachineName::kMaxLength + 1, 'x').c_str()), ENAMETOOLONG);
}

// A child process that holds the name until it is killed.
class Holder {
 public:
  explicit Holder(const std::string& name) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    pid_ = fork();
    if (pid_ == 0) {
      MachineName held;
      const bool is_held = held.hold(name.c_str()) == 0 && held.let_watch() == 0;
      (void)!write(ends[1], is_held ? "y" : "n", 1);
      for (;;) pause();
    }
    char answer = 0;
    EXPECT_EQ(read(ends[0], &answer, 1), 1);
    EXPECT_EQ(answer, 'y');
    close(ends[0]);
    close(ends[1]);
  }
  ~Holder() { end(); }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;
  void send(int signal) const { kill(pid_, signal); }
  void end() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }

 private:
  pid_t pid_ = 0;
};

TEST(MachineName, IsFreeAfterItsHolderWasKilled) {
  MachineName name;
  {
    Holder holder(name_of_this_test());
    EXPECT_EQ(name.hold(name_of_this_test().c_str()), EADDRINUSE);
  }
  EXPECT_EQ(name.hold(name_of_this_test().c_str()), 0);
}

// A pause is no end.
TEST(NameWatch, SeesTheDeathOfTheHolderAndNoPause) {
  Holder holder(name_of_this_test());
  NameWatch watch;
  EXPECT_FALSE(watch.holder_ended());
  ASSERT_TRUE(watch.start(name_of_this_test().c_str()));
  holder.send(SIGSTOP);
  EXPECT_FALSE(watch.holder_ended());
  holder.send(SIGCONT);
  EXPECT_FALSE(watch.holder_ended());
  holder.end();
  EXPECT_TRUE(watch.holder_ended());
}

TEST(NameWatch, NeedsAHolderThatLetsItBeWatched) {
  NameWatch watch;
  EXPECT_FALSE(watch.start(name_of_this_test().c_str()));
  MachineName name;
  ASSERT_EQ(name.hold(name_of_this_test().c_str()), 0);
  EXPECT_FALSE(watch.start(name_of_this_test().c_str()));
  ASSERT_EQ(name.let_watch(), 0);
  EXPECT_TRUE(watch.start(name_of_this_test().c_str()));
}

// More than there is room for: the next one is told at once.
TEST(NameWatch, NobodyWaits) {
  MachineName name;
  ASSERT_EQ(name.hold(name_of_this_test().c_str()), 0);
  ASSERT_EQ(name.let_watch(), 0);
  NameWatch watches[40];
  int started = 0;
  for (NameWatch& watch : watches) started += watch.start(name_of_this_test().c_str()) ? 1 : 0;
  EXPECT_GT(started, 4);
  EXPECT_LT(started, 40);
}

}  // namespace
}  // namespace tumblesight::hal::dds
