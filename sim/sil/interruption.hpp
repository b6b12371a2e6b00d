// Interruption: while an object lives, SIGINT, SIGTERM and SIGHUP end the SIL run, and what was done is
// reported. A second signal of the kind ends the program at once. Signals that are ignored stay ignored.
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

// Throws SilFailure after a signal.
void require_not_interrupted();

}  // namespace tumblesight::sim
