// FrameFeed: the frames of a run in order, the next one being rendered while the current one is in use.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"

namespace tumblesight::sim {

// One step of a run: which frame of which sequence, and when.
struct PlannedStep {
  std::uint32_t sequence = 0;
  std::uint32_t frame = 0;
  std::int64_t time_ns = 0;
};

// All sequences one after the other, a frame period apart without a pause between them.
std::vector<PlannedStep> plan_steps(const std::vector<Sequence>& sequences);

class FrameFeed {
 public:
  FrameFeed(const FlashLidar& lidar, double swath_m, const std::vector<Sequence>& sequences,
            const std::vector<PlannedStep>& steps);

  // The frame of the next step; valid until the next call. Sequence number = index of the step.
  const gnc::RangeImage& next();

 private:
  void render(std::size_t step, gnc::RangeImage& frame) const;
  void start_rendering(std::size_t step);

  const FlashLidar& lidar_;
  double swath_m_;
  const std::vector<Sequence>& sequences_;
  const std::vector<PlannedStep>& steps_;
  std::array<gnc::RangeImage, 2> frames_;  // one in use, one being rendered
  std::size_t next_step_ = 0;
  std::future<void> rendering_;  // last member: waits for the worker before the frames go
};

}  // namespace tumblesight::sim
