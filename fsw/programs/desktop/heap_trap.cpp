#include "fsw/programs/desktop/heap_trap.hpp"

#include <cerrno>

// glibc's own entry points behind the public names; the names are glibc's.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void* __libc_valloc(std::size_t size);
void* __libc_pvalloc(std::size_t size);
void __libc_free(void* block);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace tumblesight::hal::dds {
namespace {

struct Trap {
  bool armed = false;
  std::uint32_t allocations = 0;
  std::size_t first_bytes = 0;
};

// In the executable itself, so that touching it never allocates.
thread_local Trap trap;

void note(std::size_t size) {
  if (!trap.armed) return;
  if (trap.allocations == 0) trap.first_bytes = size;
  ++trap.allocations;
}

}  // namespace

void arm_heap_trap() {
  trap.armed = true;
}
void disarm_heap_trap() {
  trap.armed = false;
}
std::uint32_t heap_allocations() {
  return trap.allocations;
}
std::size_t first_heap_allocation_bytes() {
  return trap.first_bytes;
}

}  // namespace tumblesight::hal::dds

// operator new ends in malloc, so these are all the ways to the heap. ThreadSanitizer needs them itself: with
// it nothing is counted.
#ifndef __SANITIZE_THREAD__
extern "C" {

// Declared here: the C library's headers name the parameters otherwise.
void* memalign(std::size_t alignment, std::size_t size);
int posix_memalign(void** block, std::size_t alignment, std::size_t size);
void* valloc(std::size_t size);
void* pvalloc(std::size_t size);

void* malloc(std::size_t size) {
  tumblesight::hal::dds::note(size);
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  tumblesight::hal::dds::note(count * size);
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) {
  tumblesight::hal::dds::note(size);
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  tumblesight::hal::dds::note(size);
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  if (alignment < sizeof(void*) || (alignment & (alignment - 1)) != 0) return EINVAL;
  void* aligned = memalign(alignment, size);
  if (aligned == nullptr) return ENOMEM;
  *block = aligned;
  return 0;
}

void* valloc(std::size_t size) {
  tumblesight::hal::dds::note(size);
  return __libc_valloc(size);
}

void* pvalloc(std::size_t size) {
  tumblesight::hal::dds::note(size);
  return __libc_pvalloc(size);
}

void free(void* block) {
  __libc_free(block);
}

}  // extern "C"
#endif
