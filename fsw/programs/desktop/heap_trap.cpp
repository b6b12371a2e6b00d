#include "fsw/programs/desktop/heap_trap.hpp"

#include <cerrno>

// The C library's own allocator behind the public names.
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

namespace tumblesight::fsw::desktop {
namespace {

struct Trap {
  bool armed = false;
  std::uint32_t allocations = 0;
  std::size_t first_bytes = 0;
};

// In the executable and not in a shared library, so that the first access does not allocate.
thread_local Trap trap;

void count_allocation(std::size_t size) {
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

}  // namespace tumblesight::fsw::desktop

// operator new calls malloc, so these functions cover all allocations. ThreadSanitizer replaces them itself:
// with it nothing is counted.
#ifndef __SANITIZE_THREAD__
extern "C" {

// Declared here because the C library's headers use other parameter names.
void* memalign(std::size_t alignment, std::size_t size);
int posix_memalign(void** block, std::size_t alignment, std::size_t size);
void* valloc(std::size_t size);
void* pvalloc(std::size_t size);

void* malloc(std::size_t size) {
  tumblesight::fsw::desktop::count_allocation(size);
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  tumblesight::fsw::desktop::count_allocation(count * size);
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) {
  tumblesight::fsw::desktop::count_allocation(size);
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  tumblesight::fsw::desktop::count_allocation(size);
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
  tumblesight::fsw::desktop::count_allocation(size);
  return __libc_valloc(size);
}

void* pvalloc(std::size_t size) {
  tumblesight::fsw::desktop::count_allocation(size);
  return __libc_pvalloc(size);
}

void free(void* block) {
  __libc_free(block);
}

}  // extern "C"
#endif
