// fsw/models/fetch_images: what it says when it cannot get an image.
#include <gtest/gtest.h>

#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kNoHistory = 3;

// A copy of the script in a folder without images.
class FetchImages : public ::testing::Test {
 protected:
  FetchImages() {
    std::filesystem::create_directories(here.path("models"));
    std::filesystem::copy_file(TUMBLESIGHT_SOURCE_DIR "/fsw/models/fetch_images", script());
  }

  std::string script() const { return here.path("models/fetch_images"); }
  Outcome fetch(const std::string& arguments, const std::string& environment = "") const {
    // No repository above the temporary folder is read.
    return here.run_command("env GIT_CEILING_DIRECTORIES=" + here.path("..") + " " + environment + " " +
                                script() + " " + arguments,
                            "fetch");
  }
  void git(const std::string& arguments) const {
    const Outcome done =
        here.run_command("git -c user.name=x -c user.email=x@x -C models " + arguments, "git");
    ASSERT_EQ(done.exit_code, 0) << done.errors;
  }

  const Workplace here;
};

void expect_message(const Outcome& outcome, int exit_code, const std::string& message) {
  EXPECT_EQ(outcome.exit_code, exit_code);
  EXPECT_NE(outcome.errors.find(message), std::string::npos) << outcome.errors;
}

TEST_F(FetchImages, RefusesWrongNames) {
  expect_message(fetch("sputnik"), 1, "unknown image 'sputnik'; the images are: magellan.float32 ");
  expect_message(fetch("''"), 1, "unknown image ''");
  expect_message(fetch("--all"), 1, "unknown option '--all'; see --help");
  std::ofstream(here.path("models/magellan.tsm")) << "x";
  expect_message(fetch("magellan"), 1, "'magellan' is in the tree already: fsw/models/magellan.tsm");
}

TEST_F(FetchImages, TakesAFileNameForTheImage) {
  expect_message(fetch("fsw/models/magellan.float32.tsm"), kNoHistory,
                 "magellan.float32.tsm comes from its history");
}

TEST_F(FetchImages, SaysThatGitIsNotInstalled) {
  const std::string tools = here.path("tools");
  std::filesystem::create_directories(tools);
  for (const char* const tool :
       {"bash", "basename", "cat", "cut", "dirname", "env", "grep", "head", "sed", "sha256sum"}) {
    const Outcome found = here.run_command(std::string("command -v ") + tool, "tool");
    std::filesystem::create_symlink(found.output.substr(0, found.output.find('\n')), tools + "/" + tool);
  }
  expect_message(fetch("magellan.float32", "PATH=" + tools), kNoHistory, "git is not installed");
}

TEST_F(FetchImages, SaysHowToGetTheHistory) {
  expect_message(fetch("magellan.float32"), kNoHistory, "is not in a git repository");
  git("init --quiet");
  git("add fetch_images");
  git("commit --quiet -m one");
  expect_message(fetch("magellan.float32"), kNoHistory, "no remote to get it from");
  git("remote add origin " + here.path("models"));
  expect_message(fetch("magellan.float32"), kNoHistory, "git fetch --all");
  // The mark of a shallow clone.
  git("commit --quiet --allow-empty -m two");
  git("rev-parse HEAD");
  std::ofstream(here.path("models/.git/shallow")) << content(here.path("git.out"));
  expect_message(fetch("magellan.float32"), kNoHistory, "git fetch --unshallow");
}

}  // namespace
}  // namespace tumblesight::sim
