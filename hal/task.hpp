// PeriodicTask: wakes the flight application at absolute times.
#pragma once

#include <cstdint>

namespace tumblesight::hal {

class PeriodicTask {
 public:
  // Blocks until the next release. Adds the releases missed since the last call to `slips`. Returns the
  // release's nominal time, or the clock's time at the wake-up if the system's ticks drift from its clock.
  virtual std::int64_t wait_next_release_ns(std::uint32_t& slips) = 0;

 protected:
  ~PeriodicTask() = default;
};

}  // namespace tumblesight::hal
