// A library that tests preload into the flight program to cause a fault that no input can cause.
// TUMBLESIGHT_FAULT selects it. "heap": the flight task allocates each time that it reports the end of a
// cycle, which is after the cycle's telemetry. "thread": the program itself gets no thread; its libraries do.
// "stop at exec": SIGTERM just before the program replaces itself with another one. "slow": the flight task
// takes 15 ms each time that it looks at its clock, as on a slow processor.
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

namespace {

bool fault_is(const char* name) {
  const char* wanted = getenv("TUMBLESIGHT_FAULT");
  return wanted != nullptr && strcmp(wanted, name) == 0;
}

// The original of a function that this library replaces.
template <class Function>
Function original(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_of_flight(const void* code) {
  Dl_info info;
  if (dladdr(code, &info) == 0) return false;
  const char* slash = strrchr(info.dli_fname, '/');
  return strcmp(slash != nullptr ? slash + 1 : info.dli_fname, "flight") == 0;
}

}  // namespace

extern "C" {

int sem_post(sem_t* semaphore) noexcept {
  static const auto post = original<int (*)(sem_t*)>("sem_post");
  if (fault_is("heap")) {
    void* volatile block = malloc(77);
    free(block);
  }
  return post(semaphore);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*),
                   void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = original<Create>("pthread_create");
  if (fault_is("thread") && is_of_flight(reinterpret_cast<const void*>(run))) return EAGAIN;
  return create(thread, attributes, run, argument);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const auto get = original<int (*)(clockid_t, timespec*)>("clock_gettime");
  static const bool is_slow = fault_is("slow");
  const bool is_other_thread = gettid() != getpid();
  if (is_slow && is_other_thread && is_of_flight(__builtin_return_address(0))) usleep(15'000);
  return get(clock, time);
}

int execv(const char* path, char* const arguments[]) noexcept {
  static const auto replace = original<int (*)(const char*, char* const[])>("execv");
  if (fault_is("stop at exec") && is_of_flight(__builtin_return_address(0))) raise(SIGTERM);
  return replace(path, arguments);
}

}  // extern "C"
