// MailboxLock: guards the queues between the flight task and the bus thread. It is held for one copy at most
// and does not allocate. The mutex inherits priority: while the flight task, which has a fixed priority,
// waits for it, the bus thread that holds it runs at that priority too, so that no third thread can delay
// both.
#pragma once

#include <pthread.h>

namespace tumblesight::hal::dds {

class MailboxMutex {
 public:
  MailboxMutex() {
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    inherits_priority_ = pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT) == 0 &&
                         pthread_mutex_init(&mutex_, &attributes) == 0;
    pthread_mutexattr_destroy(&attributes);
    // A kernel without such mutexes gives a plain one.
    if (!inherits_priority_) pthread_mutex_init(&mutex_, nullptr);
  }
  ~MailboxMutex() { pthread_mutex_destroy(&mutex_); }
  MailboxMutex(const MailboxMutex&) = delete;
  MailboxMutex& operator=(const MailboxMutex&) = delete;

  bool inherits_priority() const { return inherits_priority_; }
  const pthread_mutex_t& native() const { return mutex_; }  // for the test

 private:
  friend class MailboxLock;

  pthread_mutex_t mutex_;
  bool inherits_priority_ = false;
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
