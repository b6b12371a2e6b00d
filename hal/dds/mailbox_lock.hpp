// MailboxLock: guards the queues between the flight task and the bus thread. It is held for one copy at most
// and does not allocate.
#pragma once

#include <pthread.h>

namespace tumblesight::hal::dds {

class MailboxMutex {
 public:
  MailboxMutex() = default;
  MailboxMutex(const MailboxMutex&) = delete;
  MailboxMutex& operator=(const MailboxMutex&) = delete;

 private:
  friend class MailboxLock;
// glibc's macro initializes a pointer with 0.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wzero-as-null-pointer-constant"
  pthread_mutex_t mutex_ = PTHREAD_MUTEX_INITIALIZER;
#pragma GCC diagnostic pop
};

class MailboxLock {
 public:
  explicit MailboxLock(MailboxMutex& mutex) : mutex_(mutex.mutex_) { pthread_mutex_lock(&mutex_); }
  ~MailboxLock() { pthread_mutex_unlock(&mutex_); }
  MailboxLock(const MailboxLock&) = delete;
  MailboxLock& operator=(const MailboxLock&) = delete;

 private:
  pthread_mutex_t& mutex_;
};

}  // namespace tumblesight::hal::dds
