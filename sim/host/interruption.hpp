// Interruption: while an object lives, SIGINT, SIGTERM and SIGHUP are noted, so that what was done can be
// reported. A second signal of the kind ends the program at once. Signals that are ignored stay ignored. One
// object at a time.
#pragma once

namespace tumblesight::sim {

class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  // The signal that arrived during the lifetime of the latest object; 0: none.
  static int signal();
};

}  // namespace tumblesight::sim
