// SimulatedSteps: the steps of simulated sequences in order. Renders the next frame while the current one is
// in use.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "sim/operations/scene_faults.hpp"
#include "sim/recording/step_source.hpp"
#include "sim/world/frame_renderer.hpp"

namespace tumblesight::sim {

class SimulatedSteps final : public StepSource {
 public:
  // All sequences one after the other, with a reset command before each: one step at each exposure, and one
  // nominal frame period from a sequence to the next. The sequence number of a frame is the index of its
  // step. `swath_m`: width of the frames at the target's range. `ego_motion`: with the chaser's attitudes.
  // `lidar` and `sequences` must outlive the object.
  SimulatedSteps(const FlashLidar& lidar, double swath_m, const std::vector<Sequence>& sequences,
                 bool ego_motion);

  std::uint32_t steps() const override { return static_cast<std::uint32_t>(plan_.size()); }
  std::int64_t time_ns(std::uint32_t k) const override { return plan_[k].time_ns; }
  SourcedStep next() override;
  void begin_fault(const InjectedFault& fault) override;

 private:
  struct PlannedStep {
    std::uint32_t sequence = 0;  // index
    std::uint32_t frame = 0;     // index in the sequence
    std::int64_t time_ns = 0;    // mission time
  };
  // With the faults of the scene.
  Sequence sequence_in(std::size_t step) const;
  void render(std::size_t step, gnc::RangeImage& frame) const;
  void start_rendering(std::size_t step);

  const FlashLidar& lidar_;
  FrameRenderer renderer_;
  SceneFaults faults_;
  const std::vector<Sequence>& sequences_;
  bool ego_motion_;
  std::vector<PlannedStep> plan_;
  std::array<gnc::RangeImage, 2> frames_;  // one in use, one being rendered
  std::size_t next_step_ = 0;
  bool is_stale_ = false;  // the frame that was rendered is without a fault that has begun since
  std::future<void>
      rendering_;  // last member: its destructor waits for the worker before the frames are destroyed
};

}  // namespace tumblesight::sim
