// RangeNoise: how far off the ranges of the sensor are.
#pragma once

#include <cstdint>

namespace tumblesight::gnc {

// Standard deviation of a range: constant + share of the range. The default is the paper's sensor.
struct RangeNoise {
  std::uint16_t constant_mm = 100;
  std::uint16_t share_1e5 = 1000;  // in 1/100,000
  friend bool operator==(const RangeNoise& a, const RangeNoise& b) {
    return a.constant_mm == b.constant_mm && a.share_1e5 == b.share_1e5;
  }
};

}  // namespace tumblesight::gnc
