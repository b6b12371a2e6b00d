// Watchdog: resets the processor unless it is kicked in time. The application kicks it once per cycle, after
// all duties of the cycle are done. docs/porting.md derives the time-out from the longest step.
#pragma once

namespace tumblesight::hal {

class Watchdog {
 public:
  virtual void kick() = 0;

 protected:
  ~Watchdog() = default;
};

}  // namespace tumblesight::hal
