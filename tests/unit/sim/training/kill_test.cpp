// Verifies TS-TRN-030.
// A training that is killed resumes to the same result. One without enough images for a CNN is refused at the
// start.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace {

namespace fs = std::filesystem;

pid_t start_tool(std::vector<std::string> words) {
  words.insert(words.begin(), TUMBLESIGHT_PROGRAM);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  EXPECT_EQ(posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ), 0);
  posix_spawn_file_actions_destroy(&actions);
  return child;
}

pid_t start_training(const fs::path& folder, const char* cnn_images = "384",
                     const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{"train",
                                 "--cnn-images",
                                 cnn_images,
                                 "--rcnn-sequences",
                                 "16",
                                 "--rcnn-iterations",
                                 "3",
                                 "--checkpoint-seconds",
                                 "0",
                                 "--workers",
                                 "1",
                                 "--out",
                                 folder.string()};
  words.insert(words.end(), more.begin(), more.end());
  return start_tool(words);
}

int wait_for(pid_t child) {
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(TrainingKilled, ResumesToTheSameModelImage) {
  const fs::path root = fs::temp_directory_path() / ("kill_test_" + std::to_string(getpid()));
  ASSERT_EQ(wait_for(start_training(root / "through")), 0);

  // Killed in each stage as soon as its first checkpoint exists.
  for (const char* stage : {"cnn.ckpt", "rcnn.ckpt"}) {
    const pid_t child = start_training(root / "killed");
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!fs::exists(root / "killed" / stage) && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, SIGKILL);
    const int status = wait_for(child);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the kill in " << stage << " came after the training had finished";
    EXPECT_FALSE(fs::exists(root / "killed" / "near_shoemaker.tsm"));
  }
  ASSERT_EQ(wait_for(start_training(root / "killed")), 0);
  const std::string image = contents(root / "through" / "near_shoemaker.tsm");
  EXPECT_GT(image.size(), 900'000U);
  EXPECT_TRUE(image == contents(root / "killed" / "near_shoemaker.tsm"));
  fs::remove_all(root);
}

// The scales of the image that flies are those of frames with the effects.
TEST(TrainingWithEffects, CalibratesWithThemAndQuantizeRepeatsIt) {
  const fs::path root = fs::temp_directory_path() / ("effects_test_" + std::to_string(getpid()));
  const std::string effects = "dropout=0.6";
  ASSERT_EQ(wait_for(start_training(root, "64", {"--effect", effects})), 0);
  const std::string model = (root / "near_shoemaker.float32.tsm").string();
  const fs::path again = root / "again.tsm";
  ASSERT_EQ(
      wait_for(start_tool({"quantize", "--model", model, "--effect", effects, "--out", again.string()})), 0);
  EXPECT_GT(contents(again).size(), 900'000U);
  EXPECT_TRUE(contents(root / "near_shoemaker.tsm") == contents(again));
  fs::remove_all(root);
}

TEST(TrainingWithoutACnn, IsRefusedAndCreatesNoFolder) {
  const fs::path folder = fs::temp_directory_path() / ("no_cnn_" + std::to_string(getpid()));
  const int status = wait_for(start_training(folder, "63"));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_FALSE(fs::exists(folder));
}

}  // namespace
