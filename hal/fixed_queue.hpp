// FixedQueue: a first-in first-out queue of at most N entries, without heap. A full queue drops its oldest
// entry and counts it; a user that must not lose an entry asks for room() first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumblesight::hal {

template <class T, std::size_t N>
class FixedQueue {
 public:
  // The slot of the new entry, for the caller to fill. It still holds an earlier entry.
  T& push() {
    if (size_ == N) {
      pop();
      ++dropped_;
    }
    T& slot = entries_[(first_ + size_) % N];
    ++size_;
    return slot;
  }
  // The oldest entry, or nullptr if the queue is empty. Valid until the next push().
  const T* pop() {
    if (size_ == 0) return nullptr;
    const T& oldest = entries_[first_];
    first_ = (first_ + 1) % N;
    --size_;
    return &oldest;
  }

  std::size_t room() const { return N - size_; }
  // Entries dropped since the last call.
  std::uint32_t take_dropped() {
    const std::uint32_t dropped = dropped_;
    dropped_ = 0;
    return dropped;
  }

 private:
  std::array<T, N> entries_{};
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::uint32_t dropped_ = 0;
};

}  // namespace tumblesight::hal
