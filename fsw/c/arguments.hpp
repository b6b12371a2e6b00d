// The checks of pointers that a caller passes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "fsw/c/tumblesight_c.h"

namespace tumblesight::fsw::c {

// Null is aligned.
template <class T>
bool is_aligned(const T* pointer) {
  return reinterpret_cast<std::uintptr_t>(pointer) % alignof(T) == 0;
}

// An argument that is needed.
template <class T>
tumblesight_status status_of(const T* argument) {
  if (argument == nullptr) return TUMBLESIGHT_NULL_ARGUMENT;
  return is_aligned(argument) ? TUMBLESIGHT_OK : TUMBLESIGHT_MISALIGNED_ARGUMENT;
}

// An argument that may be null.
template <class T>
tumblesight_status status_of_optional(const T* argument) {
  return is_aligned(argument) ? TUMBLESIGHT_OK : TUMBLESIGHT_MISALIGNED_ARGUMENT;
}

// Of several, the first that is wrong.
inline tumblesight_status first_wrong(std::initializer_list<tumblesight_status> statuses) {
  for (const tumblesight_status status : statuses)
    if (status != TUMBLESIGHT_OK) return status;
  return TUMBLESIGHT_OK;
}

// Memory of the caller. With a null pointer or no bytes it overlaps nothing. No sum of address and size is
// made, so none overflows.
struct Memory {
  const void* data = nullptr;
  std::size_t bytes = 0;
};

inline bool overlap(const Memory& a, const Memory& b) {
  if (a.data == nullptr || b.data == nullptr || a.bytes == 0 || b.bytes == 0) return false;
  const auto begin_a = reinterpret_cast<std::uintptr_t>(a.data);
  const auto begin_b = reinterpret_cast<std::uintptr_t>(b.data);
  return begin_a <= begin_b ? begin_b - begin_a < a.bytes : begin_a - begin_b < b.bytes;
}

template <class T>
Memory memory_of(const T* thing, std::size_t count = 1) {
  return {thing, count * sizeof(T)};
}

}  // namespace tumblesight::fsw::c
