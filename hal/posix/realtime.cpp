#include "hal/posix/realtime.hpp"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace tumblesight::hal::posix {

RealtimeGrant request_realtime(int priority) {
  RealtimeGrant grant;
  sched_param parameters{};
  parameters.sched_priority = priority;
  grant.scheduler_error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  grant.memory_lock_error = mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
  return grant;
}

}  // namespace tumblesight::hal::posix
