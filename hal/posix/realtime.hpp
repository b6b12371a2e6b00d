// Requests a fixed priority and memory that is never paged out from Linux.
#pragma once

namespace tumblesight::hal::posix {

// 0: granted; otherwise the errno (EPERM without the privilege). The task also runs without the grants, with
// more jitter, so the values are for the start-up message only.
struct RealtimeGrant {
  int scheduler_error = 0;    // SCHED_FIFO for the calling thread
  int memory_lock_error = 0;  // all current and future pages
};

// `priority`: 1 (lowest) to 99.
[[nodiscard]] RealtimeGrant request_realtime(int priority);

}  // namespace tumblesight::hal::posix
