// Navigation: the chaser's own attitude, from its attitude determination.
#pragma once

#include <cstdint>

#include "gnc/attitude/chaser_attitude.hpp"

namespace tumblesight::hal {

class Navigation {
 public:
  // The attitude at `time_ns` or at the nearest time for which it is known; ChaserAttitude::time_ns says
  // which. It is the attitude of the LiDAR's frame (LRF): with a mounting v_body = q_body_lrf v_lrf an
  // implementation returns q_inertial_body * q_body_lrf. An attitude whose time is off by more than the
  // parameter ChaserTimeTolerance_us is not used. Never blocks.
  [[nodiscard]] virtual gnc::ChaserAttitude attitude_at(std::int64_t time_ns) = 0;

 protected:
  ~Navigation() = default;
};

}  // namespace tumblesight::hal
