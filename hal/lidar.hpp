// Lidar: where the frames come from.
#pragma once

#include <cstdint>

#include "gnc/lidar/range_image.hpp"

namespace tumblesight::hal {

enum class LidarStatus : std::uint8_t {
  kFrame = 0,  // a frame has been written
  kNoFrame,    // nothing new since the last call
  kWrongSize,  // something arrived that is no frame of this interface (length or ray count); it was dropped
};

class Lidar {
 public:
  // Never blocks. Writes the oldest frame not yet delivered.
  [[nodiscard]] virtual LidarStatus receive(gnc::RangeImage& frame) = 0;

 protected:
  ~Lidar() = default;
};

}  // namespace tumblesight::hal
