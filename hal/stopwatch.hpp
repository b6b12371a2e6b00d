// Stopwatch: measures how long something took. Never used to decide anything about the attitude.
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
