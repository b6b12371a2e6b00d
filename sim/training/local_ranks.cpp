#include "sim/training/local_ranks.hpp"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "sim/host/child_process.hpp"
#include "sim/host/end_with_starter.hpp"
#include "sim/host/program_files.hpp"
#include "sim/training/rank_place.hpp"

namespace tumblesight::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFailed = 1, kStopped = 3;  // exit statuses of the tool
constexpr int kBySignal = -1;             // of ChildProcess

std::atomic<bool> stop_requested{false};

// The store's file: in memory, so that nothing of it stays behind if all processes are killed.
class StoreFile {
 public:
  StoreFile() {
    if (descriptor_ < 0)
      throw std::runtime_error(std::string("no file in memory for the ranks: ") + std::strerror(errno));
  }
  ~StoreFile() { close(descriptor_); }
  StoreFile(const StoreFile&) = delete;
  StoreFile& operator=(const StoreFile&) = delete;
  int descriptor() const { return descriptor_; }
  // In every process that inherits the descriptor.
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_ = memfd_create("tumblesight_ranks", MFD_CLOEXEC);
};

// Of this process, without its name.
std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string word; std::getline(file, word, '\0');) arguments.push_back(word);
  arguments.erase(arguments.begin());
  return arguments;
}

class Supervisor {
 public:
  explicit Supervisor(int count) {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stop_requested = true; });
    const std::string program = program_path();
    for (int rank = 0; rank < count; ++rank) {
      std::vector<std::string> environment = local_rank_environment(rank, count, store_.path());
      environment.push_back(starter_environment());
      ranks_.push_back(
          std::make_unique<ChildProcess>(program, own_arguments(), "", store_.descriptor(), environment));
    }
  }
  // At once: a rank does not end by itself while it waits for another one.
  ~Supervisor() { signal_all(SIGKILL); }
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  int wait() {
    while (any_running() && !failed()) pause();
    if (!failed()) return ranks_.front()->exit_status();
    // The first to end may have failed because of another one, whose end is noticed a little later.
    const auto deadline = Clock::now() + std::chrono::milliseconds(300);
    while (any_running() && !ended_by_signal() && Clock::now() < deadline) pause();
    if (is_stopped()) {
      std::printf("Stopped before the ranks had found each other.\n");
      return kStopped;
    }
    return report(ended_by_signal() ? *ended_by_signal() : *failed());
  }

 private:
  void signal_all(int signal) {
    for (const auto& rank : ranks_) {
      if (rank->running()) kill(rank->pid(), signal);
    }
  }

  void pause() {
    if (stop_requested.exchange(false)) {
      is_stopping_ = true;
      signal_all(SIGTERM);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  bool any_running() {
    bool any = false;
    for (const auto& rank : ranks_) any = rank->running() || any;
    return any;
  }

  template <typename Test>
  std::optional<std::size_t> first_that(const Test& test) const {
    const auto found = std::find_if(ranks_.begin(), ranks_.end(),
                                    [&](const auto& rank) { return rank->ended() && test(*rank); });
    if (found == ranks_.end()) return {};
    return found - ranks_.begin();
  }
  std::optional<std::size_t> failed() const {
    return first_that(
        [](const ChildProcess& rank) { return !rank.ended_well() && rank.exit_status() != kStopped; });
  }
  std::optional<std::size_t> ended_by_signal() const {
    return first_that([](const ChildProcess& rank) { return rank.exit_status() == kBySignal; });
  }

  // Until a rank has joined the others, the signal that stops it ends it at once. Ctrl-C reaches it directly.
  bool is_stopped() const {
    const std::optional<std::size_t> rank = ended_by_signal();
    if (!rank || !(is_stopping_ || stop_requested)) return false;
    const int signal = ranks_[*rank]->ending_signal();
    return signal == SIGINT || signal == SIGTERM;
  }

  int report(std::size_t index) const {
    const ChildProcess& rank = *ranks_[index];
    if (rank.exit_status() != kBySignal) {  // it has said why
      std::fprintf(stderr, "tumblesight: rank %zu failed; the other ranks are ended, too\n", index);
      return rank.exit_status();
    }
    std::fprintf(stderr,
                 "tumblesight: rank %zu (process %d) %s; the other ranks are ended, too. The same command "
                 "continues from the last checkpoint\n",
                 index, static_cast<int>(rank.pid()), rank.how_it_ended().c_str());
    return kFailed;
  }

  bool is_stopping_ = false;
  StoreFile store_;
  std::vector<std::unique_ptr<ChildProcess>> ranks_;
};

}  // namespace

int run_local_ranks(int count) {
  return Supervisor(count).wait();
}

}  // namespace tumblesight::sim
