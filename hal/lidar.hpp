// Lidar: the source of frames.
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::hal {

enum class LidarStatus : std::uint8_t {
  kFrame = 0,      // `frame` has been written
  kNoFrame = 1,    // nothing new since the last call
  kWrongSize = 2,  // data with the wrong length or ray count arrived and was dropped
};

class Lidar {
 public:
  // Deliveries that may wait for the next cycle, which receives all of them. A sensor that delivers more in a
  // cycle would otherwise be received later and later, until all of its frames are stale. So an
  // implementation keeps at most this many, drops the oldest first and counts it.
  static constexpr int kMaxWaiting = 32;

  // Never blocks. Writes the oldest frame not yet delivered. `frame` may be overwritten for any result.
  [[nodiscard]] virtual LidarStatus receive(gnc::RangeImage& frame) = 0;
  // Deliveries dropped since the last call. The application counts them.
  virtual std::uint32_t take_dropped() { return 0; }

 protected:
  ~Lidar() = default;
};

}  // namespace tumblesight::hal
