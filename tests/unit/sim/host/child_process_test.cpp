#include "sim/host/child_process.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {
namespace {

TEST(ChildProcess, IsFoundInThePathAndTellsHowItEnded) {
  ChildProcess good("true", {}, "");
  ChildProcess bad("sh", {"-c", "exit 7"}, "");
  ASSERT_TRUE(good.wait_for_end(10.0));
  ASSERT_TRUE(bad.wait_for_end(10.0));
  EXPECT_TRUE(good.ended_well());
  EXPECT_FALSE(bad.ended_well());
  EXPECT_EQ(bad.how_it_ended(), "ended with exit status 7");
  EXPECT_EQ(bad.ending_signal(), 0);
}

TEST(ChildProcess, EndsWithItsObject) {
  pid_t pid = 0;
  {
    ChildProcess sleeper("sleep", {"1000"}, "");
    pid = sleeper.pid();
    EXPECT_TRUE(sleeper.running());
  }
  EXPECT_NE(kill(pid, 0), 0);
}

TEST(ChildProcess, ASignalIsNamed) {
  ChildProcess sleeper("sleep", {"1000"}, "");
  kill(sleeper.pid(), SIGKILL);
  ASSERT_TRUE(sleeper.wait_for_end(10.0));
  EXPECT_EQ(sleeper.how_it_ended(), "was ended by signal 9 (Killed)");
  EXPECT_EQ(sleeper.exit_status(), -1);
  EXPECT_EQ(sleeper.ending_signal(), SIGKILL);
}

TEST(ChildProcess, AMissingProgramIsNamed) {
  try {
    ChildProcess process("no_such_program_of_ours", {}, "");
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("no_such_program_of_ours cannot be started: No such file"),
              std::string::npos)
        << error.what();
  }
}

TEST(ChildProcess, AFileThatCannotBeWrittenIsNamedAndNotTheProgram) {
  const TemporaryFolder folder;
  for (const bool is_log : {true, false}) {
    try {
      ChildProcess process("true", {}, is_log ? folder.path("") : folder.path("log"), -1, {},
                           is_log ? "" : folder.path(""));
      FAIL() << "no exception";
    } catch (const ProgramFailure& error) {
      FAIL() << error.what();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("': Is a directory"), std::string::npos) << error.what();
    }
  }
}

TEST(ChildProcess, ALogIsNotWrittenThroughALinkOfAnotherUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make files of another user";
  constexpr uid_t kOther = 65534;
  const TemporaryFolder folder;
  const std::string precious = folder.put("precious", {'x'}), link = folder.path("log");
  std::filesystem::create_symlink(precious, link);
  ASSERT_EQ(lchown(link.c_str(), kOther, kOther), 0);
  EXPECT_THROW(ChildProcess("true", {}, link), std::runtime_error);
  EXPECT_EQ(std::filesystem::file_size(precious), 1U);
}

TEST(OutputOf, GivesStandardOutputAloneWithoutTheLastLineBreak) {
  EXPECT_EQ(output_of("sh", {"-c", "echo one; echo two >&2"}, 10.0), "one");
}

// Ctrl-C in a terminal signals a process group. What asks another program waits for its answer.
// The system's message alone names no folder.
TEST(OutputOf, NamesAFolderForTemporaryFilesThatIsNotThere) {
  const char* const before = getenv("TMPDIR");
  const std::string former = before != nullptr ? before : "";
  setenv("TMPDIR", "/no/such/folder", 1);
  try {
    output_of("true", {}, 10.0);
    ADD_FAILURE() << "not refused";
  } catch (const std::runtime_error& error) {
    for (const char* part : {"'/no/such/folder'", "set TMPDIR to one that exists"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  if (before != nullptr)
    setenv("TMPDIR", former.c_str(), 1);
  else
    unsetenv("TMPDIR");
}

TEST(OutputOf, IsOfAProgramInAGroupOfItsOwn) {
  const std::string group = output_of("sh", {"-c", "cut -d ' ' -f 5 /proc/$$/stat"}, 10.0);
  EXPECT_NE(group, std::to_string(getpgrp()));
  EXPECT_GT(std::stoi(group), 0);
}

TEST(OutputOf, AFailureComesWithTheOutputAndATimeoutWithItsLimit) {
  const auto fault_of = [](const std::string& script, double timeout_s) -> std::string {
    try {
      output_of("sh", {"-c", script}, timeout_s);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no exception";
  };
  EXPECT_EQ(fault_of("echo no such queue; exit 3", 10.0), "sh ended with exit status 3: no such queue");
  EXPECT_EQ(fault_of("echo 17; echo no room >&2; exit 3", 10.0), "sh ended with exit status 3: 17: no room");
  EXPECT_EQ(fault_of("exec sleep 1000", 1.0), "sh takes longer than 1 s");
}

}  // namespace
}  // namespace tumblesight::sim
