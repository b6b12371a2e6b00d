// The heap trap: counts what a thread allocates. Linked into the desktop flight program only, where it stands
// in front of the C library's allocator for every library of the process, Cyclone DDS included.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::hal::dds {

// From now on the calling thread's allocations count. Other threads are never counted.
void arm_heap_trap();
void disarm_heap_trap();

// Of the calling thread since the trap was armed first.
std::uint32_t heap_allocations();
std::size_t first_heap_allocation_bytes();  // size of the first one, to find the culprit; 0 if there was none

}  // namespace tumblesight::hal::dds
