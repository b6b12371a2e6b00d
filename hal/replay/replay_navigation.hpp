// ReplayNavigation: the chaser's attitude at the exposure of the recorded frame that was delivered last.
#pragma once

#include <cstdint>

#include "hal/navigation.hpp"
#include "hal/replay/recording.hpp"

namespace tumblesight::hal::replay {

class ReplayNavigation final : public Navigation {
 public:
  explicit ReplayNavigation(const Recording& recording) : recording_(recording) {}

  [[nodiscard]] gnc::ChaserAttitude attitude_at(std::int64_t) override {
    return recording_.chaser_attitude();
  }

 private:
  const Recording& recording_;
};

}  // namespace tumblesight::hal::replay
