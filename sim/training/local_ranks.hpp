// Several ranks on this machine: copies of this process, which a supervisor starts and waits for.
#pragma once

namespace tumblesight::sim {

// Starts this program `count` times with its own arguments, as ranks of one training, and waits until all
// have ended. SIGINT and SIGTERM are passed on. When a rank fails, the others are ended, and the rank is
// named on stderr. If this process is killed, the ranks stop as after SIGTERM. Returns the exit status: that
// of the rank that failed, of rank 0, or 1 after a signal.
int run_local_ranks(int count);

}  // namespace tumblesight::sim
