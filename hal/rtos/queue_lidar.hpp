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

  // Sensor. A buffer for the next frame. If none is free, the oldest frame that waits is dropped and counted.
  // nullptr: the system failed.
  [[nodiscard]] gnc::RangeImage* begin_frame() {
    std::uint32_t number = 0;
    if (free_.receive(number)) return &buffers_[number];
    count_dropped();
    return waiting_.receive(number) ? &buffers_[number] : nullptr;
  }
  // `buffer`: from begin_frame(), with the frame.
  void end_frame(const gnc::RangeImage* buffer) {
    if (!waiting_.send(static_cast<std::uint32_t>(buffer - buffers_.data()))) count_dropped();
  }

  // Flight task. kWrongSize: the ray count is 0 or above RangeImage::kMaxRays.
  [[nodiscard]] LidarStatus receive(gnc::RangeImage& frame) override {
    std::uint32_t number = 0;
    if (!waiting_.receive(number)) return LidarStatus::kNoFrame;
    const gnc::RangeImage& buffer = buffers_[number];
    const bool fits = buffer.rays > 0 && buffer.rays <= gnc::RangeImage::kMaxRays;
    if (fits) frame = buffer;
    static_cast<void>(free_.send(number));  // it has room for all of them
    return fits ? LidarStatus::kFrame : LidarStatus::kWrongSize;
  }
  std::uint32_t take_dropped() override {
    std::uint32_t dropped = 0;
    return dropped_.receive(dropped) ? dropped : 0;
  }

 private:
  void count_dropped() { static_cast<void>(dropped_.send(take_dropped() + 1)); }

  std::array<gnc::RangeImage, kBuffers> buffers_;
  Queue<std::uint32_t, kBuffers> free_;
  Queue<std::uint32_t, kBuffers> waiting_;
  Queue<std::uint32_t, 1> dropped_;  // only the sensor sends
};

}  // namespace tumblesight::hal::rtos
