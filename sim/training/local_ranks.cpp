#include "sim/training/local_ranks.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/training/rank_place.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// A folder of its own for the store's file.
class StoreFolder {
 public:
  StoreFolder() : path_((fs::temp_directory_path() / "tumblesight_ranks_XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) throw std::runtime_error(path_ + ": " + std::strerror(errno));
  }
  StoreFolder(const StoreFolder&) = delete;
  StoreFolder& operator=(const StoreFolder&) = delete;
  ~StoreFolder() {
    std::error_code none;
    fs::remove_all(path_, none);
  }
  std::string file() const { return path_ + "/store"; }

 private:
  std::string path_;
};

std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string word; std::getline(file, word, '\0');) arguments.push_back(word);
  return arguments;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> result;
  for (std::string& word : words) result.push_back(word.data());
  result.push_back(nullptr);
  return result;
}

std::vector<std::string> environment_of(int rank, int count, const std::string& store_file) {
  std::vector<std::string> all = local_rank_environment(rank, count, store_file);
  for (char** variable = environ; *variable != nullptr; ++variable) all.emplace_back(*variable);
  return all;
}

struct LocalRank {
  pid_t process = -1;
  std::optional<int> status;  // of waitpid(), once it has ended
};

bool has_failed(const LocalRank& rank) {
  constexpr int kStopped = 3;
  if (!rank.status) return false;
  return WIFSIGNALED(*rank.status) ||
         (WEXITSTATUS(*rank.status) != 0 && WEXITSTATUS(*rank.status) != kStopped);
}

class Supervisor {
 public:
  explicit Supervisor(int count) {
    sigemptyset(&signals_);
    for (const int signal : {SIGCHLD, SIGINT, SIGTERM}) sigaddset(&signals_, signal);
    sigprocmask(SIG_BLOCK, &signals_, &before_);
    for (int rank = 0; rank < count; ++rank) ranks_.push_back({start(rank, count), {}});
  }
  ~Supervisor() {
    signal_all(SIGKILL);
    while (!all_ended()) collect(kASecond);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  int wait() {
    while (!all_ended() && !failed()) collect(kASecond);
    if (!failed()) return WEXITSTATUS(*ranks_.front().status);
    // The first to end may have failed because of another one, whose end is noticed a little later.
    const auto deadline = Clock::now() + std::chrono::milliseconds(300);
    while (!all_ended() && !failed_by_signal() && Clock::now() < deadline) collect(kShortly);
    return report(failed_by_signal() ? *failed_by_signal() : *failed());
  }

 private:
  static constexpr timespec kASecond{1, 0};
  static constexpr timespec kShortly{0, 50'000'000};

  pid_t start(int rank, int count) {
    std::vector<std::string> words = own_arguments();
    std::vector<std::string> variables = environment_of(rank, count, store_.file());
    const std::vector<char*> argv = pointers(words), envp = pointers(variables);
    const std::string program = fs::read_symlink("/proc/self/exe");
    const pid_t supervisor = getpid();
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error(std::string("cannot start a rank: ") + std::strerror(errno));
    if (child > 0) return child;
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != supervisor) _exit(1);
    sigprocmask(SIG_SETMASK, &before_, nullptr);
    execve(program.c_str(), argv.data(), envp.data());
    _exit(127);
  }

  void signal_all(int signal) {
    for (const LocalRank& rank : ranks_) {
      if (!rank.status) kill(rank.process, signal);
    }
  }

  // Waits for a signal, passes it on, and takes up the ranks that have ended.
  void collect(const timespec& at_most) {
    const int signal = sigtimedwait(&signals_, nullptr, &at_most);
    if (signal == SIGINT || signal == SIGTERM) signal_all(SIGTERM);
    for (LocalRank& rank : ranks_) {
      int status = 0;
      if (!rank.status && waitpid(rank.process, &status, WNOHANG) == rank.process) rank.status = status;
    }
  }

  bool all_ended() const {
    return std::all_of(ranks_.begin(), ranks_.end(), [](const LocalRank& rank) { return rank.status; });
  }

  template <typename Test>
  std::optional<int> first_that(const Test& test) const {
    const auto found = std::find_if(ranks_.begin(), ranks_.end(), test);
    if (found == ranks_.end()) return {};
    return static_cast<int>(found - ranks_.begin());
  }
  std::optional<int> failed() const { return first_that(has_failed); }
  std::optional<int> failed_by_signal() const {
    return first_that([](const LocalRank& rank) { return rank.status && WIFSIGNALED(*rank.status); });
  }

  int report(int rank) const {
    constexpr int kFailed = 1;
    const LocalRank& failed = ranks_[static_cast<std::size_t>(rank)];
    if (!WIFSIGNALED(*failed.status)) {  // it has said why
      std::fprintf(stderr, "tumblesight: rank %d failed; the other ranks are ended, too\n", rank);
      return WEXITSTATUS(*failed.status);
    }
    const int signal = WTERMSIG(*failed.status);
    std::fprintf(
        stderr,
        "tumblesight: rank %d (process %d) was ended by signal %d (%s); the other ranks are ended, too. "
        "The same command continues from the last checkpoint\n",
        rank, static_cast<int>(failed.process), signal, strsignal(signal));
    return kFailed;
  }

  StoreFolder store_;
  sigset_t signals_{}, before_{};
  std::vector<LocalRank> ranks_;
};

}  // namespace

int run_local_ranks(int count) {
  return Supervisor(count).wait();
}

}  // namespace tumblesight::sim
