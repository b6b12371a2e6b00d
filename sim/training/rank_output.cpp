#include "sim/training/rank_output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>

#include "sim/training/ranks.hpp"

namespace tumblesight::sim {
namespace {

// While it lives, a stream's file is /dev/null.
class Dropped {
 public:
  explicit Dropped(std::FILE* stream) : stream_(stream), kept_(dup(fileno(stream))) {
    std::fflush(stream_);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    dup2(nowhere, fileno(stream_));
    close(nowhere);
  }
  Dropped(const Dropped&) = delete;
  Dropped& operator=(const Dropped&) = delete;
  ~Dropped() {
    std::fflush(stream_);
    dup2(kept_, fileno(stream_));
    close(kept_);
  }

 private:
  std::FILE* stream_;
  int kept_;
};

}  // namespace

int run_quietly_unless_first(int rank, const std::function<int()>& job) {
  if (rank == 0) return job();
  const Dropped output(stdout), errors(stderr);
  try {
    return job();
  } catch (const RankLost&) {
    throw;  // names the rank
  } catch (const std::runtime_error& error) {
    // Rank 0 mostly fails for the same reason, and a supervisor ends this process once it has said so.
    std::this_thread::sleep_for(std::chrono::seconds(1));
    throw std::runtime_error("rank " + std::to_string(rank) + ": " + error.what());
  }
}

}  // namespace tumblesight::sim
