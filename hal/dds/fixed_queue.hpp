// FixedQueue: first in, first out, at most N; a full queue loses its oldest entry.
#pragma once

#include <array>
#include <cstddef>

namespace tumblesight::hal::dds {

template <class T, std::size_t N>
class FixedQueue {
 public:
  // The slot of the new entry, still holding what an earlier one left there.
  T& push() {
    if (size_ == N) pop();
    T& slot = entries_[(first_ + size_) % N];
    ++size_;
    return slot;
  }
  // The oldest entry, or nullptr; valid until the next push().
  const T* pop() {
    if (size_ == 0) return nullptr;
    const T& oldest = entries_[first_];
    first_ = (first_ + 1) % N;
    --size_;
    return &oldest;
  }

 private:
  std::array<T, N> entries_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace tumblesight::hal::dds
