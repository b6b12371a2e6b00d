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
  // Never blocks. Writes the oldest frame not yet delivered. `frame` may be overwritten for any result.
  [[nodiscard]] virtual LidarStatus receive(gnc::RangeImage& frame) = 0;

 protected:
  ~Lidar() = default;
};

}  // namespace tumblesight::hal
