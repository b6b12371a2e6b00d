// PaintedStack: the stack of one thread, in static memory and filled with a pattern, so that it shows how
// much of it was never used.
#pragma once

#include <pthread.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::hal::posix {

class PaintedStack {
 public:
  // A step needs a few KiB (docs/audit.md); the rest is for what the C library does on a thread's behalf.
#ifdef __SANITIZE_THREAD__
  static constexpr std::size_t kBytes =
      2048 * 1024;  // the sanitizer's own storage of a thread lies there too
#else
  static constexpr std::size_t kBytes = 256 * 1024;
#endif

  PaintedStack() {
    words_.fill(kPattern);
  }
  PaintedStack(const PaintedStack&) = delete;
  PaintedStack& operator=(const PaintedStack&) = delete;

  // Starts the one thread that runs on it; false if the system gives none.
  [[nodiscard]] bool start(pthread_t& thread, void* (*main)(void*), void* argument);

  // The margin: bytes at the far end that no call has reached so far.
  std::uint32_t least_left_bytes() const;

 private:
  static constexpr std::uint64_t kPattern = 0x7357'AC4B'5EED'0FF5U;  // no address, and no small number
  alignas(64) std::array<std::uint64_t, kBytes / sizeof(std::uint64_t)> words_;
};

}  // namespace tumblesight::hal::posix
