// Stopwatch: measures durations, and says when a cycle is late. Of what is estimated only the registration of
// a late cycle depends on it.
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
