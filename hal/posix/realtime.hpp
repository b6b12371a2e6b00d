// Asks Linux for what a periodic flight task wants: a fixed priority and memory that is never paged out.
#pragma once

namespace tumblesight::hal::posix {

// 0: granted; otherwise the errno why not (EPERM without the privilege). The task runs without it too, only
// less punctually, so that this is for the start-up message.
struct RealtimeGrant {
  int scheduler_error = 0;    // SCHED_FIFO for the calling thread
  int memory_lock_error = 0;  // all pages now and later
};

// `priority`: 1 (lowest) to 99.
[[nodiscard]] RealtimeGrant request_realtime(int priority);

}  // namespace tumblesight::hal::posix
