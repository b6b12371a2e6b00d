// RtemsQueue: a message queue of RTEMS 6 whose buffers are members of it.
#pragma once

#include <rtems.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tumblesight::hal::rtos {

template <class T, std::size_t kDepth>
class RtemsQueue {
 public:
  static_assert(std::is_trivially_copyable_v<T>, "RTEMS copies messages byte by byte");

  // From a task or device driver. False: CONFIGURE_MAXIMUM_MESSAGE_QUEUES is too small.
  [[nodiscard]] bool open() {
    rtems_message_queue_config config{};
    config.name = rtems_build_name('T', 'S', 'G', 'T');
    config.maximum_pending_messages = kDepth;
    config.maximum_message_size = sizeof(T);
    config.storage_area = storage_;
    config.storage_size = sizeof storage_;
    config.attributes = RTEMS_DEFAULT_ATTRIBUTES;
    return rtems_message_queue_construct(&config, &id_) == RTEMS_SUCCESSFUL;
  }
  // False: the queue is full (RTEMS_TOO_MANY) or was not opened (RTEMS_INVALID_ID).
  [[nodiscard]] bool send(const T& message) {
    return rtems_message_queue_send(id_, &message, sizeof message) == RTEMS_SUCCESSFUL;
  }
  // False: the queue is empty (RTEMS_UNSATISFIED) or was not opened.
  [[nodiscard]] bool receive(T& message) {
    std::size_t size = 0;
    return rtems_message_queue_receive(id_, &message, &size, RTEMS_NO_WAIT, RTEMS_NO_TIMEOUT) ==
           RTEMS_SUCCESSFUL;
  }
  std::size_t room() {
    std::uint32_t waiting = kDepth;
    static_cast<void>(rtems_message_queue_get_number_pending(id_, &waiting));
    return kDepth - waiting;
  }

 private:
  rtems_id id_ = 0;  // never that of an object
  RTEMS_MESSAGE_QUEUE_BUFFER(sizeof(T)) storage_[kDepth];
};

}  // namespace tumblesight::hal::rtos
