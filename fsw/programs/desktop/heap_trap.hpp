// Heap trap: counts the allocations of one thread. It replaces the allocator of the program that it is linked
// into, for every library of the process including Cyclone DDS. Only the desktop flight program links it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::fsw::desktop {

// Starts and stops counting the calling thread's allocations. Other threads are not counted.
void arm_heap_trap();
void disarm_heap_trap();

// Of the calling thread, while the trap was armed.
std::uint32_t heap_allocations();
std::size_t first_heap_allocation_bytes();  // helps to find the cause; 0: no allocation

}  // namespace tumblesight::fsw::desktop
