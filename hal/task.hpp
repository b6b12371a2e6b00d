// PeriodicTask: wakes the flight application at absolute times.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

class PeriodicTask {
 public:
  // Blocks until the next release and returns its nominal time. Adds the releases missed since the last call
  // to `slips`.
  virtual std::int64_t wait_next_release_ns(std::uint32_t& slips) = 0;

 protected:
  ~PeriodicTask() = default;
};

}  // namespace tumblesight::hal
