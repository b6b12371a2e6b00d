// ReplayLidar: delivers each frame of a recording when its exposure time has come.
#pragma once

#include <cstdint>

#include "hal/lidar.hpp"
#include "hal/replay/recording.hpp"

namespace tumblesight::hal::replay {

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

}  // namespace tumblesight::hal::replay
