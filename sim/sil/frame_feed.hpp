// FrameFeed: the frames of a run in order. Renders the next frame while the current one is in use.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/world/frame_renderer.hpp"

namespace tumblesight::sim {

// One step of a run.
struct PlannedStep {
  std::uint32_t sequence = 0;  // index
  std::uint32_t frame = 0;     // index in the sequence
  std::int64_t time_ns = 0;    // mission time
};

// All sequences one after the other, one step at each exposure, and one nominal frame period from a sequence
// to the next.
std::vector<PlannedStep> plan_steps(const std::vector<Sequence>& sequences);

class FrameFeed {
 public:
  // All arguments must outlive the feed.
  FrameFeed(const FlashLidar& lidar, double swath_m, const std::vector<Sequence>& sequences,
            const std::vector<PlannedStep>& steps);

  // The frame of the next step; valid until the next call. Its sequence number is the index of the step. Of a
  // lost frame the content is undefined. Must be called at most once per step.
  const gnc::RangeImage& next();

 private:
  void render(std::size_t step, gnc::RangeImage& frame) const;
  void start_rendering(std::size_t step);

  FrameRenderer renderer_;
  const std::vector<Sequence>& sequences_;
  const std::vector<PlannedStep>& steps_;
  std::array<gnc::RangeImage, 2> frames_;  // one in use, one being rendered
  std::size_t next_step_ = 0;
  std::future<void>
      rendering_;  // last member: its destructor waits for the worker before the frames are destroyed
};

}  // namespace tumblesight::sim
