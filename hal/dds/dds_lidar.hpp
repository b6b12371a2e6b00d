// DdsLidar: the frames of topic sil/lidar_frame as the LiDAR of the flight application. The bus thread puts
// them in, the flight task receives them.
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/topics.hpp"
#include "hal/dds/mailbox_lock.hpp"
#include "hal/fixed_queue.hpp"
#include "hal/lidar.hpp"

namespace tumblesight::hal::dds {

class DdsLidar final : public Lidar {
 public:
  // A full queue drops its oldest frame.
  void put(const LidarFrameSample& sample);

  // kWrongSize: the ray count is 0 or above RangeImage::kMaxRays. Other faults are left to the application.
  [[nodiscard]] LidarStatus receive(gnc::RangeImage& frame) override;
  std::uint32_t take_dropped() override;

 private:
  struct Entry {
    bool wrong_size = false;
    gnc::RangeImage frame;
  };

  static_assert(2 * kMaxFramesPerStep <= kMaxWaiting, "a cycle receives everything that waits");

  MailboxMutex mutex_;
  FixedQueue<Entry, 2 * kMaxFramesPerStep> waiting_;
};

}  // namespace tumblesight::hal::dds
