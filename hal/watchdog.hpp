// Watchdog: resets the processor unless it is kicked in time. It is kicked once a cycle, after every duty of
// the cycle.
#pragma once

namespace tumblesight::hal {

class Watchdog {
 public:
  virtual void kick() = 0;

 protected:
  ~Watchdog() = default;
};

}  // namespace tumblesight::hal
