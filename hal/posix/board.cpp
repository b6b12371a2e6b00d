#include "hal/board.hpp"

#include <cstdio>
#include <cstdlib>

#include "hal/posix/monotonic_stopwatch.hpp"

namespace tumblesight::hal::board {

void write(const char* text) {
  std::fputs(text, stdout);
}

std::uint64_t now_ns() {
  return posix::MonotonicStopwatch().now_ns();
}

void end(int status) {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    std::perror("standard output");
    if (status == 0) status = EXIT_FAILURE;
  }
  std::_Exit(status);
}

}  // namespace tumblesight::hal::board
