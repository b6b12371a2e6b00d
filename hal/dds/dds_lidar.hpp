// DdsLidar: frames of topic sil/lidar_frame as the LiDAR of the flight application. The bus thread puts them
// in, the flight task takes them out.
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/fixed_queue.hpp"
#include "hal/dds/idl/topics.hpp"
#include "hal/dds/mailbox_lock.hpp"
#include "hal/lidar.hpp"

namespace tumblesight::hal::dds {

class DdsLidar final : public Lidar {
 public:
  void put(const LidarFrameSample& sample);

  // A frame whose ray count cannot be one of this interface is kWrongSize.
  [[nodiscard]] LidarStatus receive(gnc::RangeImage& frame) override;

 private:
  struct Entry {
    bool wrong_size = false;
    gnc::RangeImage frame;
  };

  MailboxMutex mutex_;
  FixedQueue<Entry, 2 * kMaxFramesPerStep> waiting_;
};

}  // namespace tumblesight::hal::dds
