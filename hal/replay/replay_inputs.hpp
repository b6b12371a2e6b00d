// A recording as the application's inputs.
#pragma once

#include <cstdint>

#include "hal/lidar.hpp"
#include "hal/navigation.hpp"
#include "hal/replay/recording.hpp"

namespace tumblesight::hal::replay {

// ReplayLidar: delivers each frame of a recording when its exposure time has come.
class ReplayLidar final : public Lidar {
 public:
  explicit ReplayLidar(Recording& recording) : recording_(recording) {}
  void advance_to(std::int64_t now_ns) { now_ns_ = now_ns; }

  LidarStatus receive(gnc::RangeImage& frame) override {
    if (!recording_.has_next() || recording_.next_exposure_time_ns() > now_ns_) return LidarStatus::kNoFrame;
    recording_.read_next(frame);
    return LidarStatus::kFrame;
  }

 private:
  Recording& recording_;
  std::int64_t now_ns_ = 0;
};

// ReplayNavigation: the chaser's attitude at the exposure of the recorded frame that was delivered last.
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
