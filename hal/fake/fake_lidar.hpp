// FakeLidar: delivers the frames that a test has added, in order. Host only.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "hal/lidar.hpp"

namespace tumblesight::hal::fake {

class FakeLidar final : public Lidar {
 public:
  void add(const gnc::RangeImage& frame) { add(LidarStatus::kFrame, frame); }
  void add_wrong_size() { add(LidarStatus::kWrongSize, gnc::RangeImage{}); }
  std::size_t waiting() const { return script_.size(); }

  LidarStatus receive(gnc::RangeImage& frame) override {
    if (script_.empty()) return LidarStatus::kNoFrame;
    const LidarStatus status = script_.front().first;
    if (status == LidarStatus::kFrame) frame = script_.front().second;
    script_.pop_front();
    return status;
  }
  std::uint32_t take_dropped() override { return std::exchange(dropped_, 0U); }

 private:
  void add(LidarStatus status, const gnc::RangeImage& frame) {
    script_.emplace_back(status, frame);
    if (script_.size() <= kMaxWaiting) return;
    script_.pop_front();
    ++dropped_;
  }

  std::deque<std::pair<LidarStatus, gnc::RangeImage>> script_;
  std::uint32_t dropped_ = 0;
};

}  // namespace tumblesight::hal::fake
