// MonitoredStack: the stack of one thread in static memory, filled with a pattern that shows its
// high-water mark: the deepest use so far.
#pragma once

#include <pthread.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::hal::posix {

class MonitoredStack {
 public:
  // A step needs a few KiB (docs/audit.md). The rest is for the C library.
#ifdef __SANITIZE_THREAD__
  static constexpr std::size_t kBytes = 2048 * 1024;  // includes the sanitizer's data of the thread
#else
  static constexpr std::size_t kBytes = 256 * 1024;
#endif

  MonitoredStack() {
    words_.fill(kPattern);
  }
  MonitoredStack(const MonitoredStack&) = delete;
  MonitoredStack& operator=(const MonitoredStack&) = delete;

  // Starts the thread that uses this stack, once. False if the system provides no thread.
  [[nodiscard]] bool start(pthread_t& thread, void* (*main)(void*), void* argument);

  // Bytes at the end of the stack that no call has reached so far.
  std::uint32_t least_left_bytes() const;

 private:
  static constexpr std::uint64_t kPattern =
      0x7357'AC4B'5EED'0FF5U;  // neither a valid address nor a small number
  alignas(64) std::array<std::uint64_t, kBytes / sizeof(std::uint64_t)> words_;
};

}  // namespace tumblesight::hal::posix
