// FakeLidar: delivers the frames that a test has added, in order. Host only.
#pragma once

#include <deque>
#include <utility>

#include "hal/lidar.hpp"

namespace tumblesight::hal::fake {

class FakeLidar final : public Lidar {
 public:
  void add(const gnc::RangeImage& frame) { script_.emplace_back(LidarStatus::kFrame, frame); }
  void add_wrong_size() { script_.emplace_back(LidarStatus::kWrongSize, gnc::RangeImage{}); }
  std::size_t waiting() const { return script_.size(); }

  LidarStatus receive(gnc::RangeImage& frame) override {
    if (script_.empty()) return LidarStatus::kNoFrame;
    const LidarStatus status = script_.front().first;
    if (status == LidarStatus::kFrame) frame = script_.front().second;
    script_.pop_front();
    return status;
  }

 private:
  std::deque<std::pair<LidarStatus, gnc::RangeImage>> script_;
};

}  // namespace tumblesight::hal::fake
