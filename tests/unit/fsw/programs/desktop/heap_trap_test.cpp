// Verifies TS-MEM-020.
#include "fsw/programs/desktop/heap_trap.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>
#include <thread>

namespace tumblesight::fsw::desktop {
namespace {

// Keeps the compiler from removing an allocation whose result is not used.
void use(void* block) {
  asm volatile("" : : "g"(block) : "memory");
}

template <class Action>
std::uint32_t allocations_during(Action&& action) {
  const std::uint32_t before = heap_allocations();
  arm_heap_trap();
  action();
  disarm_heap_trap();
  return heap_allocations() - before;
}

TEST(HeapTrap, CountsEveryAllocationFunction) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer replaces the allocator";
#endif
  EXPECT_EQ(allocations_during([] {}), 0U);
  void* block = nullptr;
  EXPECT_EQ(allocations_during([&] { use(block = std::malloc(17)); }), 1U);
  EXPECT_EQ(allocations_during([&] { use(block = std::realloc(block, 4000)); }), 1U);
  std::free(block);
  EXPECT_EQ(allocations_during([&] { use(block = std::calloc(3, 5)); }), 1U);
  std::free(block);
  EXPECT_EQ(allocations_during([&] { use(block = std::aligned_alloc(64, 128)); }), 1U);
  std::free(block);
  EXPECT_EQ(allocations_during([&] { EXPECT_EQ(posix_memalign(&block, 256, 512), 0); }), 1U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 256, 0U);
  std::free(block);
  EXPECT_EQ(allocations_during([&] { use(block = valloc(10)); }), 1U);
  std::free(block);
  EXPECT_EQ(allocations_during([&] { use(block = pvalloc(10)); }), 1U);
  std::free(block);
  EXPECT_EQ(allocations_during([&] { use(block = ::operator new(9)); }), 1U);
  ::operator delete(block);
}

TEST(HeapTrap, RemembersTheSizeOfTheFirstAllocation) {
  std::thread([] {
    arm_heap_trap();
    void* first = std::malloc(1234);
    void* second = std::malloc(5);
    disarm_heap_trap();
    use(first);
    use(second);
    std::free(first);
    std::free(second);
    EXPECT_EQ(heap_allocations(), 2U);
    EXPECT_EQ(first_heap_allocation_bytes(), 1234U);
  }).join();
}

TEST(HeapTrap, CountsOnlyTheArmedThread) {
  std::thread other;
  void* block = nullptr;
  const std::uint32_t count_before = heap_allocations();
  other = std::thread([&] { use(block = std::malloc(8)); });
  arm_heap_trap();
  other.join();
  disarm_heap_trap();
  EXPECT_EQ(heap_allocations(), count_before);
  std::free(block);
}

}  // namespace
}  // namespace tumblesight::fsw::desktop
