// ZephyrQueue: a message queue of Zephyr whose buffers are members of it.
#pragma once

#include <zephyr/kernel.h>

#include <cstddef>
#include <type_traits>

namespace tumblesight::hal::rtos {

template <class T, std::size_t kDepth>
class ZephyrQueue {
 public:
  static_assert(std::is_trivially_copyable_v<T>, "Zephyr copies messages byte by byte");

  ZephyrQueue() = default;
  ZephyrQueue(const ZephyrQueue&) = delete;  // the kernel keeps its address
  ZephyrQueue& operator=(const ZephyrQueue&) = delete;

  // Always true.
  [[nodiscard]] bool open() {
    k_msgq_init(&queue_, storage_, sizeof(T), kDepth);
    return true;
  }
  // False: the queue is full (-ENOMSG).
  [[nodiscard]] bool send(const T& message) { return k_msgq_put(&queue_, &message, K_NO_WAIT) == 0; }
  // False: the queue is empty (-ENOMSG).
  [[nodiscard]] bool receive(T& message) { return k_msgq_get(&queue_, &message, K_NO_WAIT) == 0; }
  std::size_t room() { return k_msgq_num_free_get(&queue_); }

 private:
  struct k_msgq queue_ {};
  alignas(T) char storage_[kDepth * sizeof(T)] = {};
};

}  // namespace tumblesight::hal::rtos
