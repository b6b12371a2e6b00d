// Stopwatch: measures durations. No attitude depends on it.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

class Stopwatch {
 public:
  virtual std::uint64_t now_ns() = 0;  // monotonic, arbitrary origin

 protected:
  ~Stopwatch() = default;
};

}  // namespace tumblesight::hal
