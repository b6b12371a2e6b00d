// QueueLidar: frames from the task of the sensor to the flight task. The buffers are members; their numbers
// go through message queues, from a queue of free buffers to one of waiting frames and back, so that a buffer
// never has two users. Queue: see queue_link.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/lidar.hpp"

namespace tumblesight::hal::rtos {

template <template <class, std::size_t> class Queue>
class QueueLidar final : public Lidar {
 public:
  static constexpr std::size_t kBuffers = 4;  // at least 3: one in each task, one that waits
  static_assert(kBuffers >= 3 && kBuffers <= kMaxWaiting);

  // Creates the queues. False: the system refused one.
  [[nodiscard]] bool open() {
    bool is_open = free_.open() && waiting_.open() && dropped_.open();
    for (std::uint32_t number = 0; number < kBuffers; ++number) is_open = is_open && free_.send(number);
    return is_open;
  }

  // Sensor. A buffer for the next frame: one at a time. If a frame was begun and not ended, it is given up,
  // and its buffer is returned again. If no buffer is free, the oldest frame that waits is dropped and
  // counted. nullptr: the system failed.
  [[nodiscard]] gnc::RangeImage* begin_frame() {
    if (!begun_.is_held) begun_.is_held = free_.receive(begun_.number);
    if (!begun_.is_held) {
      begun_.is_held = waiting_.receive(begun_.number);
      count_dropped();
    }
    return begun_.is_held ? &buffers_[begun_.number] : nullptr;
  }
  // `buffer`: from begin_frame(), with the frame. Any other pointer, and a second call, do nothing. If the
  // system refuses the frame, it is dropped and counted, and the next frame gets its buffer.
  void end_frame(const gnc::RangeImage* buffer) {
    if (!begun_.is_held || buffer != &buffers_[begun_.number]) return;
    begun_.is_held = !waiting_.send(begun_.number);
    if (begun_.is_held) count_dropped();
  }

  // Flight task. kWrongSize: the ray count is 0 or above RangeImage::kMaxRays.
  [[nodiscard]] LidarStatus receive(gnc::RangeImage& frame) override {
    free_received();
    if (received_.is_held || !waiting_.receive(received_.number)) return LidarStatus::kNoFrame;
    received_.is_held = true;
    const gnc::RangeImage& buffer = buffers_[received_.number];
    const bool fits = buffer.rays > 0 && buffer.rays <= gnc::RangeImage::kMaxRays;
    if (fits) frame = buffer;
    free_received();
    return fits ? LidarStatus::kFrame : LidarStatus::kWrongSize;
  }
  std::uint32_t take_dropped() override {
    std::uint32_t dropped = 0;
    return dropped_.receive(dropped) ? dropped : 0;
  }

 private:
  // A buffer that is in no queue.
  struct Held {
    std::uint32_t number = 0;
    bool is_held = false;
  };

  // The queue has room for all buffers. If the system refuses this one, the next call tries again.
  void free_received() {
    if (received_.is_held) received_.is_held = !free_.send(received_.number);
  }
  void count_dropped() { static_cast<void>(dropped_.send(take_dropped() + 1)); }

  std::array<gnc::RangeImage, kBuffers> buffers_;
  Held begun_;     // sensor
  Held received_;  // flight task
  Queue<std::uint32_t, kBuffers> free_;
  Queue<std::uint32_t, kBuffers> waiting_;
  Queue<std::uint32_t, 1> dropped_;  // only the sensor sends
};

}  // namespace tumblesight::hal::rtos
