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
  std::fflush(stdout);
  std::_Exit(status);
}

}  // namespace tumblesight::hal::board
