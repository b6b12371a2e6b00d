// Navigation: the source of the chaser's own attitude.
#pragma once

#include <cstdint>

#include "gnc/tracking/chaser_attitude.hpp"

namespace tumblesight::hal {

class Navigation {
 public:
  // Never blocks. The attitude whose time is nearest to `time_ns`, the exposure of a frame; its time tells
  // whether it is near enough. Not valid: there is none.
  [[nodiscard]] virtual gnc::ChaserAttitude attitude_at(std::int64_t time_ns) = 0;

 protected:
  ~Navigation() = default;
};

}  // namespace tumblesight::hal
